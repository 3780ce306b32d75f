//! Tests of the rules for a servo's first pulses: each exception ends where its reason ends.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;
use lizard_rules::{Event, Limits, MS, Observer, Pulse, Rule, Time};

const REST: Event<'_> = Event::Order {
    effect: Effect::Rests,
    done: Some(true),
};
const STAND: Event<'_> = Event::Order {
    effect: Effect::Moves,
    done: Some(true),
};
const RESETS_IN_A_ROW: &str =
    "# fault: reset several times in a row by the button or a weak supply, resting";

fn pulse(servo: usize) -> Event<'static> {
    Event::Pulse(Pulse {
        servo,
        width: 24_000,
        is_cut: false,
        is_held_up: false,
    })
}

/// Sends one pulse to each servo, 4 ms apart, at this time, ms.
fn pulse_all(observer: &mut Observer, ms: Time) {
    for servo in 0..4 {
        observer.observe((ms + 4 * servo as Time) * MS, pulse(servo));
    }
}

/// An observer of a robot that woke at power-on, one servo every 100 ms from 100 ms on, and whose last pulses are
/// those of the frame at 440 ms.
fn awake() -> Observer {
    let mut observer = Observer::new(Limits {
        queued: 150 * MS,
        ..Limits::default()
    });
    observer.observe(0, Event::Supply(5_000));
    observer.observe(0, Event::Start(Cause::Power));
    for frame in 0..=17 {
        for servo in 0..=(frame / 5).min(3) {
            let ms = 100 + 20 * frame + 4 * servo;
            observer.observe(ms * MS, pulse(servo as usize));
        }
    }
    assert_eq!(observer.verdict(), Ok(()));
    observer
}

/// An observer of a robot whose program hangs at 450 ms; the watchdog resets it at 600 ms. `rest` is sent at `rest_ms`.
fn hung(rest_ms: Time) -> Observer {
    let mut observer = awake();
    let mut events = [
        (450, Event::Stalled(605 * MS)),
        (600, Event::Start(Cause::Watchdog)),
        (rest_ms, REST),
    ];
    events.sort_by_key(|(ms, _)| *ms);
    for (ms, event) in events {
        observer.observe(ms * MS, event);
    }
    observer
}

fn broken_rules(observer: &mut Observer) -> Vec<Rule> {
    let broken = observer.take_broken();
    broken.into_iter().map(|broken| broken.rule).collect()
}

#[test]
fn the_frame_after_a_hang_is_completed_although_a_rest_comes_in_it_or_was_lost_in_the_hang() {
    for rest_ms in [500, 620] {
        let mut observer = hung(rest_ms);
        pulse_all(&mut observer, 625);
        assert_eq!(broken_rules(&mut observer), [], "rest at {rest_ms} ms");
    }
}

#[test]
fn servos_that_rest_after_a_hang_wake_one_by_one() {
    let mut observer = hung(620);
    observer.observe(740 * MS, STAND);
    pulse_all(&mut observer, 825);
    assert_eq!(broken_rules(&mut observer), [Rule::OneByOne; 3]);
}

#[test]
fn a_pulse_that_blocked_interrupts_have_cost_is_no_wake_up_but_any_other_gap_is() {
    for (is_held_up, expected) in [(true, &[][..]), (false, &[Rule::OneByOne])] {
        let mut observer = awake();
        if is_held_up {
            observer.observe(455 * MS, Event::HeldUp(457 * MS));
        }
        // A2's pulse of the frame at 460 ms is missing; A4 woke at 412 ms.
        observer.observe(460 * MS, pulse(0));
        observer.observe(484 * MS, pulse(1));
        let broken = broken_rules(&mut observer);
        assert_eq!(broken, expected, "held up: {is_held_up}");
    }
}

#[test]
fn servos_that_stay_silent_after_blocked_interrupts_wake_one_by_one() {
    let mut observer = awake();
    observer.observe(455 * MS, Event::HeldUp(457 * MS));
    pulse_all(&mut observer, 540);
    assert_eq!(broken_rules(&mut observer), [Rule::OneByOne; 3]);
}

#[test]
fn a_report_of_a_rest_that_waited_in_the_queue_is_older_than_the_order_before_it() {
    for (printed_from_ms, expected) in [(640, &[][..]), (700, &[Rule::Begins])] {
        let mut observer = awake();
        observer.observe(450 * MS, Event::Cut);
        observer.observe(455 * MS, Event::Start(Cause::BrownOut));
        observer.observe(530 * MS, STAND);
        let report = Event::Printed(printed_from_ms * MS, RESETS_IN_A_ROW);
        observer.observe(710 * MS, report);
        observer.observe(760 * MS, pulse(0));
        let broken = broken_rules(&mut observer);
        assert_eq!(broken, expected, "printed from {printed_from_ms} ms");
    }
}
