//! Main held up at every instruction where it meets an interrupt: at the hand-over
//! of a frame, at the LED, in an answer, before it falls asleep.

use lizard_host::sim::frame::FRAME;
use lizard_host_tests::FirmwareBench;
use simulated_uno::Fidelity;

use crate::kept::{pulses, way};
use crate::walk::{SLOT, Walk};
use crate::{Status, awake, in_both};

/// Cycles from the return of the function that computes a frame in which main
/// hands it over and sets the LED, and more. Three frames for each are an odd number
/// of the LED's beats, of 32: a second sweep finds it lit where the first did not.
const HAND_OVER: u64 = 608;

/// Runs main into its next frame and to the return of the function that computes it.
fn run_to_hand_over(bench: &mut FirmwareBench) {
    let frame = bench.uno.image().function("Control::frame");
    let entry = frame.expect("it computes a frame").address as u32;
    let uno = &mut bench.uno;
    assert!(uno.run_until(FRAME, 1, |uno| uno.pc() == entry));
    let byte = |address| u16::from(uno.peek(address));
    let stack = byte(0x5d) | byte(0x5e) << 8;
    let back = u32::from(byte(stack + 1) << 8 | byte(stack + 2)) * 2;
    assert!(uno.run_until(FRAME, 1, |uno| uno.pc() == back));
}

#[test]
fn a_frame_is_played_whole_or_not_at_all_wherever_main_stops_in_the_hand_over() {
    // Main stops until A1's pulse has begun: the next frame is taken over in
    // between, and the pin of A1 rises, which may share its port with the LED. Twice
    // in a row, so that it stops also while an older frame waits; every third frame
    // is left alone.
    in_both(|fidelity| {
        let mut walk = Walk::begin(fidelity);
        let start = walk.next_frame() + FRAME;
        let count = 2 * 3 * HAND_OVER;
        for n in (0..count).filter(|n| n % 3 != 2) {
            let frame = start + n * FRAME;
            walk.run_to(frame - SLOT - 400);
            run_to_hand_over(&mut walk.bench);
            walk.bench.uno.run_cycles(n / 3 % HAND_OVER);
            let stall = frame + 2_000 - walk.bench.uno.cycle();
            walk.bench.uno.stall_main(stall);
            walk.run_to(frame + 2_000);
        }
        walk.run_to(start + count * FRAME - SLOT / 2);
        let frames = walk.frames_since(start);
        assert_eq!(frames.len() as u64, count);
        let mut in_time = 0;
        for (n, (sent, asked)) in frames.iter().enumerate().skip(3) {
            let is_asked = sent.all() == Some(*asked);
            let recent = &frames[n - 2..n];
            // One that comes too late is played later, unless the next takes it back.
            let is_old = recent.iter().any(|(_, asked)| sent.all() == Some(*asked));
            assert!(
                is_asked || n % 3 != 2 && is_old,
                "{} cycles in: {sent:?}",
                n / 3
            );
            in_time += usize::from(is_asked);
        }
        // Most: at the end of the sweep main has handed over before it stops.
        assert!((frames.len() / 3 + 40..frames.len() - 40).contains(&in_time));
        assert_eq!(walk.late(), 0);
    });
}

#[test]
fn an_answer_is_the_same_wherever_main_stops_in_writing_it() {
    // For two bytes' time, so that the line takes all that it is given meanwhile.
    const STOP: u64 = 3_000;
    in_both(|fidelity| {
        let mut bench = awake(fidelity);
        // What else there was to say is said before.
        assert_eq!(bench.say("stop"), "ok stop");
        for cycles in 0..4_500 {
            bench.send("stop");
            bench.uno.run_cycles(6_700);
            assert!(bench.uno.run_until(1_000, 1, |uno| uno.unsent() == 0));
            bench.uno.run_cycles(cycles);
            bench.uno.stall_main(STOP);
            assert_eq!(
                bench.next_line(20).as_deref(),
                Some("ok stop"),
                "{cycles} cycles in"
            );
        }
        assert_eq!(Status::of(&mut bench).number("rx_lost"), 0.0);
    });
}

#[test]
fn a_byte_at_any_cycle_of_falling_asleep_wakes_main_at_once() {
    in_both(|fidelity| {
        let mut walk = Walk::stand(fidelity);
        let begin = walk.next_frame();
        // Main wakes for each pulse's rise, finds nothing and falls asleep again.
        for n in 0..700 {
            let rise = begin + n / 4 * FRAME + n % 4 * SLOT;
            walk.run_to(rise - 20_000);
            walk.bench.uno.send(b"stop");
            let said = walk.bench.bytes().len();
            // The receiver has the byte 9.5 bits after its start.
            let comes = rise - 200 + n;
            walk.run_to(comes - 1_320);
            walk.bench.uno.send(b"\n");
            walk.run_to(comes + 20_000);
            let answer = walk.bench.bytes()[said].cycle - comes;
            assert!(answer < 12_000, "answered {answer} cycles after {n}");
        }
    });
}

#[test]
fn ticks_that_main_misses_are_left_out_and_no_servo_leaps_for_them() {
    in_both(|fidelity| {
        let mut walk = Walk::begin(fidelity);
        walk.next_frame();
        let before = Status::of(&mut walk.bench).number("frames");
        let cycle = walk.bench.uno.cycle();
        walk.bench.uno.take_edges();
        // Shorter than the watchdog's patience.
        for _ in 0..20 {
            walk.bench.uno.stall_main(5 * FRAME);
            walk.bench.run_ms(300);
        }
        for (servo, pulses) in pulses(&walk.bench).iter().enumerate() {
            assert!(pulses.len() > 250);
            for pair in pulses.windows(2) {
                // What main had computed before may have been replaced unplayed.
                let leap = pair[0].width.abs_diff(pair[1].width);
                assert!(leap <= 3 * way(servo), "A{}: {pair:?}", servo + 1);
            }
        }
        let frames = Status::of(&mut walk.bench).number("frames") - before;
        let passed = (walk.bench.uno.cycle() - cycle) as f64 / FRAME as f64;
        let missed = passed - frames;
        assert!((70.0..=101.0).contains(&missed), "{missed} of {passed}");
    });
}

#[test]
fn old_widths_repeat_while_main_stands_still() {
    let mut walk = Walk::begin(Fidelity::DataSheet);
    let start = walk.next_frame();
    walk.bench.uno.stall_main(5 * FRAME);
    walk.run_to(start + 4 * FRAME + FRAME / 2);
    let frames = walk.frames_since(start);
    let (last, _) = frames[1];
    assert!(
        frames[1..]
            .iter()
            .all(|(frame, _)| frame.all() == last.all())
    );
    assert!(last.all().is_some());
}
