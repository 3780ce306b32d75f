//! Interrupts held up: by no more than the rules of the pulses allow, and by more.

use fastrand::Rng;
use lizard_host::sim::frame::{FRAME, Frame};
use simulated_uno::{CYCLES_PER_MS, most_pins_high};

use crate::pulses::servo_edges;
use crate::walk::{SLOT, Walk};
use crate::{in_both, neutral_widths};

/// What other handlers and stretches with interrupts off may take, cycles.
const MAY_TAKE: u64 = 160;

/// Something that keeps interrupts off for `length` cycles, so many before an edge.
#[derive(Clone, Copy, Debug)]
struct Hold {
    before: u64,
    length: u64,
}

/// Which edges are held up.
#[derive(Clone, Copy, PartialEq)]
enum Edges {
    Rising,
    Falling,
    Both,
}

/// A frame for each hold, in which the edges of all servos meet it.
fn sweep(walk: &mut Walk, edges: Edges, holds: &[Hold]) -> Vec<(Frame, [u64; 4])> {
    let start = walk.next_frame();
    let commands = walk.commands(start, holds.len() as u64);
    for (n, (hold, command)) in holds.iter().zip(commands).enumerate() {
        for (servo, width) in command.into_iter().enumerate() {
            let rise = start + n as u64 * FRAME + servo as u64 * SLOT;
            let both = [(Edges::Rising, rise), (Edges::Falling, rise + width)];
            for (edge, cycle) in both {
                if edges == Edges::Both || edges == edge {
                    walk.run_to(cycle - hold.before);
                    walk.bench.uno.hold(hold.length);
                }
            }
        }
    }
    walk.run_to(start + holds.len() as u64 * FRAME - SLOT / 2);
    walk.frames_since(start)
}

/// Holds of several lengths that are longer than allowed, at every few cycles from
/// too early to matter to the edge itself.
fn too_long() -> Vec<Hold> {
    [200, 230, 300, 500, 900]
        .into_iter()
        .flat_map(|length| {
            let starts = (0..length + 300).step_by(7);
            starts.map(move |before| Hold { before, length })
        })
        .collect()
}

#[test]
fn what_takes_no_longer_than_the_rules_allow_moves_no_edge_wherever_it_begins() {
    in_both(|fidelity| {
        let mut walk = Walk::begin(fidelity);
        let length = MAY_TAKE;
        let holds: Vec<Hold> = (0..450).map(|before| Hold { before, length }).collect();
        for (n, (frame, asked)) in sweep(&mut walk, Edges::Both, &holds).iter().enumerate() {
            assert_eq!(frame.all(), Some(*asked), "{:?}: {frame:?}", holds[n]);
        }
        assert_eq!(walk.late(), 0);
    });
}

#[test]
fn a_late_rising_edge_drops_its_pulse_and_is_counted() {
    in_both(|fidelity| {
        let mut walk = Walk::begin(fidelity);
        let holds = too_long();
        let mut dropped = 0;
        for (n, (frame, asked)) in sweep(&mut walk, Edges::Rising, &holds).iter().enumerate() {
            for (sent, asked) in frame.widths.into_iter().zip(asked) {
                dropped += u64::from(sent.is_none());
                assert!(
                    sent.is_none_or(|sent| sent == *asked),
                    "{:?}: {frame:?}",
                    holds[n]
                );
            }
        }
        let edges = 4 * holds.len() as u64;
        assert!(
            (edges / 4..edges * 3 / 4).contains(&dropped),
            "{dropped} of {edges}"
        );
        assert_eq!(walk.late(), dropped);
    });
}

#[test]
fn a_late_falling_edge_is_made_at_once_and_counted() {
    in_both(|fidelity| {
        let mut walk = Walk::begin(fidelity);
        let holds = too_long();
        let mut late = 0;
        for (n, (frame, asked)) in sweep(&mut walk, Edges::Falling, &holds).iter().enumerate() {
            let Hold { before, length } = holds[n];
            for (sent, asked) in frame.widths().into_iter().zip(asked) {
                late += u64::from(sent != *asked);
                // From the end of the hold on it takes a handler's beginning.
                let latest = (asked + length + 90).saturating_sub(before).max(*asked);
                assert!(
                    (*asked..=latest).contains(&sent),
                    "{:?}: {frame:?}",
                    holds[n]
                );
            }
        }
        let edges = 4 * holds.len() as u64;
        assert!(
            (edges / 4..edges * 3 / 4).contains(&late),
            "{late} of {edges}"
        );
        assert_eq!(walk.late(), late);
    });
}

#[test]
fn after_milliseconds_without_interrupts_no_pulse_is_short_and_none_lasts_beyond_its_slot() {
    in_both(|fidelity| {
        let mut walk = Walk::stand(fidelity);
        let mut rng = Rng::with_seed(5);
        for _ in 0..200 {
            walk.bench.run_for_frames(0);
            walk.bench.uno.run_cycles(rng.u64(..FRAME));
            let length = rng.u64(1_000..5 * CYCLES_PER_MS);
            walk.bench.uno.hold(length);
            walk.bench.run_ms(30);
            let pins = walk.bench.pins();
            let edges = servo_edges(&walk.bench.uno);
            assert_eq!(most_pins_high(&edges), 1);
            for (pin, neutral) in pins.into_iter().zip(neutral_widths()) {
                for pulse in walk.bench.uno.pulses(pin) {
                    // At worst interrupts come back in the middle of the next slot.
                    let latest = neutral.max(SLOT + 300).max(neutral + length);
                    assert!(
                        (neutral..=latest).contains(&pulse.width),
                        "{pin}: {pulse:?} after {length} cycles"
                    );
                }
            }
        }
        for frame in walk.bench.run_for_frames(3) {
            assert_eq!(frame.widths(), neutral_widths());
        }
    });
}
