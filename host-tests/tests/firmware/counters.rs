//! Tests of the fault counters: they count every fault, can be read while they change, and stay at their maximum.

use lizard_host::sim::frame::FRAME_CYCLES;
use simulated_uno::Fidelity;

use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{Status, boot_to_stand, start_in_both_simulations};

#[test]
fn each_overrun_of_the_receiver_is_counted() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let mut lost_bytes_before = 0;
    for overrun_count in 1..=5 {
        // Two bytes wait in the buffer, a third is in the shift register, and more arrive.
        bench.uno.send(&[b' '; 12]);
        bench.uno.run_cycles(2_000);
        bench.uno.block_interrupts(8_000);
        bench.run_ms(20);
        assert!(bench.uno.overrun_count() > lost_bytes_before);
        lost_bytes_before = bench.uno.overrun_count();
        bench.uno.send(b"\n");
        bench.run_ms(20);
        Status::read(&mut bench).assert_has(&format!("rx_lost={overrun_count}"));
    }
}

#[test]
fn a_counter_read_during_a_carry_has_its_old_or_new_value() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        let late_edges_address = run.variable_address("pulses::LATE_EDGES");
        // The count written here stops the robot, and after 20 s the frame count has four digits, so all answers have
        // the same length.
        run.bench.uno.poke(late_edges_address, 255);
        run.bench.run_ms(20_000);
        let start = run.run_to_next_frame();
        let (mut old_value_count, mut new_value_count) = (0, 0);
        // The main loop is to read the count about `read_lead` cycles before A2's rising edge: when the last part of its
        // answer to `status` begins, `answer_delay` cycles after the line arrives. Interrupts lengthen this delay
        // depending on the phase of the frame, so it is measured until it no longer changes. Each attempt takes three
        // frames, so that an answer is complete before the next line is sent.
        let a2_rise_cycle = |n: u64| start + 3 * n * FRAME_CYCLES + SLOT_CYCLES;
        let (mut answer_delay, mut read_lead, mut attempt) = (150_000, 2_800, 0);
        loop {
            attempt += 1;
            let arrival_cycle = a2_rise_cycle(attempt) - read_lead - answer_delay;
            let new_delay = measure_answer_delay(&mut run, arrival_cycle);
            if new_delay == answer_delay {
                break;
            }
            // At some phases of the frame, the frame's interrupt delays only some answers. After four attempts, the
            // read is therefore aimed earlier, where the interrupt delays every answer or none.
            read_lead += 200 * u64::from(attempt > 4);
            answer_delay = new_delay;
            assert!(attempt < 40, "the answer delay does not converge");
        }
        // Stalls the main loop at different times around its read of the count, and delays A2's rising edge during
        // the stall.
        for round in 0..500 {
            // Sending the answer takes most of a frame, and a `#` line may come before it.
            let rise = a2_rise_cycle(attempt + round + 2);
            run.run_to(rise - read_lead - answer_delay - 15_000);
            run.bench.uno.poke(late_edges_address, 255);
            run.bench.uno.poke(late_edges_address + 1, 0);
            let line_count_before = run.bench.lines().len();
            send_status_at(&mut run, rise - read_lead - answer_delay);
            run.run_to(rise - read_lead - 500 + 2 * round);
            let uno = &mut run.bench.uno;
            uno.stall_main(rise + 1_000 - uno.cycle());
            run.run_to(rise - 600);
            run.bench.uno.block_interrupts(700);
            run.run_to(rise + 550_000);
            assert_eq!(run.read_word("pulses::LATE_EDGES"), 256);
            let lines = &run.bench.lines()[line_count_before..];
            let answer = lines.iter().find(|line| line.is_answer());
            let answer = Status(answer.expect("the robot answers").text.clone());
            match answer.text("late") {
                "255" => old_value_count += 1,
                "256" => new_value_count += 1,
                _ => panic!("round {round}: unexpected count in {answer:?}"),
            }
        }
        let counts = [old_value_count, new_value_count];
        assert!(
            counts.iter().all(|count| *count > 20),
            "{counts:?}: the stalls did not reach both sides of the read"
        );
    });
}

/// Sends `status` so that the line's last byte arrives at `arrival_cycle`.
fn send_status_at(run: &mut ReferenceRun, arrival_cycle: u64) {
    run.run_to(arrival_cycle - 12_000);
    run.bench.uno.send(b"status");
    // The receiver has a complete byte 9.5 bits after its start.
    run.run_to(arrival_cycle - 1_320);
    run.bench.uno.send(b"\n");
}

/// Sends `status` so that its last byte arrives at `arrival_cycle`. Returns the cycles from this byte to the last part
/// of the answer, which contains the counts.
fn measure_answer_delay(run: &mut ReferenceRun, arrival_cycle: u64) -> u64 {
    send_status_at(run, arrival_cycle);
    let part_calls = run.bench.time_calls("print::print_answer", 30);
    assert_eq!(part_calls.len(), 3, "{part_calls:?}");
    part_calls[2].enter_cycle - arrival_cycle
}

#[test]
fn a_counter_at_its_maximum_stays_there() {
    let mut run = ReferenceRun::start_standing(Fidelity::DataSheet);
    let late_edges_address = run.variable_address("pulses::LATE_EDGES");
    run.bench.uno.poke(late_edges_address, 0xff);
    run.bench.uno.poke(late_edges_address + 1, 0xff);
    let a1_rise_cycle = run.run_to_next_frame();
    run.run_to(a1_rise_cycle - 600);
    run.bench.uno.block_interrupts(700);
    run.bench.run_ms(20);
    assert_eq!(run.late_edge_count(), 65_535);
    Status::read(&mut run.bench).assert_has("late=65535");
}
