//! Tests of the fault counters: each fault is provoked, and its counter is read while it changes.

use lizard_host::sim::frame::FRAME;
use simulated_uno::Fidelity;

use crate::walk::{ReferenceRun, SLOT_CYCLES};
use crate::{Status, boot_standing, run_in_both_simulations};

#[test]
fn each_overrun_of_the_receiver_is_counted() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let mut overruns = 0;
    for n in 1..=5 {
        // Two bytes wait in the buffer, a third is in the shift register, and more arrive.
        bench.uno.send(&[b' '; 12]);
        bench.uno.run_cycles(2_000);
        bench.uno.block_interrupts(8_000);
        bench.run_ms(20);
        assert!(bench.uno.overruns() > overruns);
        overruns = bench.uno.overruns();
        bench.uno.send(b"\n");
        bench.run_ms(20);
        assert_eq!(Status::of(&mut bench).number("rx_lost"), f64::from(n));
    }
}

#[test]
fn a_count_that_carries_while_main_reads_it_is_read_as_before_or_after() {
    run_in_both_simulations(|fidelity| {
        let mut walk = ReferenceRun::start_standing(fidelity);
        let late_address = walk.address("pulses::LATE");
        // From here on, the robot has stopped because of a late pulse, and the count of frames has four digits, so
        // all answers have the same length.
        walk.bench.uno.poke(late_address, 255);
        walk.bench.run_ms(20_000);
        let start = walk.next_frame();
        let mut seen_counts = [0, 0];
        // The main loop reads the count about `read_lead` cycles before it writes the last part of the answer, which
        // is `answer_delay` cycles after the line arrives. Interrupts for ticks and edges lengthen `answer_delay` by
        // an amount that depends on when in the frame they come. So `answer_delay` is measured repeatedly, with the
        // read aimed at a rising edge, until it no longer changes. Each attempt takes three frames, so that an answer
        // is complete before the next line is sent.
        let rise_of_frame = |n: u64| start + 3 * n * FRAME + SLOT_CYCLES;
        let (mut answer_delay, mut read_lead, mut frame) = (150_000, 2_800, 0);
        loop {
            frame += 1;
            let new_delay =
                measure_answer_delay(&mut walk, rise_of_frame(frame) - read_lead - answer_delay);
            if new_delay == answer_delay {
                break;
            }
            // At some points of the frame, a tick delays the answer only sometimes. A little earlier in the frame, it
            // delays every answer or none.
            read_lead += 200 * u64::from(frame > 4);
            answer_delay = new_delay;
            assert!(frame < 40, "the answer takes as long each time");
        }
        // Stalls main at different times around its read of the count, and delays A2's rising edge during the
        // stall.
        for n in 0..500 {
            // Sending the answer takes most of a frame, and a note may come before it.
            let rise = rise_of_frame(frame + n + 2);
            walk.run_to(rise - read_lead - answer_delay - 15_000);
            walk.bench.uno.poke(late_address, 255);
            walk.bench.uno.poke(late_address + 1, 0);
            let lines_before = walk.bench.lines().len();
            send_status_at(&mut walk, rise - read_lead - answer_delay);
            walk.run_to(rise - read_lead - 500 + 2 * n);
            let now = walk.bench.uno.cycle();
            walk.bench.uno.stall_main(rise + 1_000 - now);
            walk.run_to(rise - 600);
            walk.bench.uno.block_interrupts(700);
            walk.run_to(rise + 550_000);
            assert_eq!(walk.word("pulses::LATE"), 256);
            let lines = &walk.bench.lines()[lines_before..];
            let answer = lines.iter().find(|line| line.is_answer());
            let answer = answer.expect("it answers").text.clone();
            let count = answer
                .split(' ')
                .find_map(|pair| pair.strip_prefix("late="));
            match count {
                Some("255") => seen_counts[0] += 1,
                Some("256") => seen_counts[1] += 1,
                count => panic!("{count:?} in the sweep's step {n}: {answer}"),
            }
        }
        assert!(
            seen_counts[0] > 20 && seen_counts[1] > 20,
            "{seen_counts:?}: both sides of the read"
        );
    });
}

/// Sends `status` so that the line's last byte arrives at cycle `arrival`.
fn send_status_at(walk: &mut ReferenceRun, arrival: u64) {
    walk.run_to(arrival - 12_000);
    walk.bench.uno.send(b"status");
    // The receiver has a complete byte 9.5 bits after its start.
    walk.run_to(arrival - 1_320);
    walk.bench.uno.send(b"\n");
}

/// Returns the cycles from the last byte of `status`, which arrives at cycle `arrival`, to the last part of its
/// answer, which contains the counts.
fn measure_answer_delay(walk: &mut ReferenceRun, arrival: u64) -> u64 {
    send_status_at(walk, arrival);
    let part_calls = walk.bench.time_calls("print::answer", 30);
    assert_eq!(part_calls.len(), 3, "{part_calls:?}");
    part_calls[2].enter - arrival
}

#[test]
fn a_counter_that_is_full_stays_full() {
    let mut walk = ReferenceRun::start_standing(Fidelity::DataSheet);
    let late_address = walk.address("pulses::LATE");
    walk.bench.uno.poke(late_address, 0xff);
    walk.bench.uno.poke(late_address + 1, 0xff);
    let rise = walk.next_frame();
    walk.run_to(rise - 600);
    walk.bench.uno.block_interrupts(700);
    walk.bench.run_ms(20);
    assert_eq!(walk.late_edge_count(), 65_535);
    assert_eq!(Status::of(&mut walk.bench).number("late"), 65_535.0);
}
