//! Tests of the rules for a servo's first pulse after a pause, with their exceptions after a hang or a reset.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;
use lizard_rules::{Event, Limits, MS, Observer, Pulse, Rule, Time};

const REPEATED_RESETS_REPORT: &str =
    "# fault: reset several times in a row by the button or a weak supply, resting";

fn accepted_command(effect: Effect) -> Event<'static> {
    Event::MotionCommand {
        effect,
        is_accepted: Some(true),
    }
}

fn pulse(servo: usize) -> Event<'static> {
    Event::Pulse(Pulse::exact(servo, 24_000))
}

/// Passes one pulse of each servo to the observer, 4 ms apart from `start_ms` on.
fn observe_pulses_of_all_servos(observer: &mut Observer, start_ms: Time) {
    for servo in 0..4 {
        observer.observe((start_ms + 4 * servo as Time) * MS, pulse(servo));
    }
}

/// Returns an observer of a robot whose servos woke after power-on, one every 100 ms from 100 ms on. The last frame
/// with pulses is at 440 ms.
fn observer_of_awake_robot() -> Observer {
    let mut observer = Observer::new(Limits {
        max_queue_time: 150 * MS,
        ..Limits::default()
    });
    observer.observe(0, Event::SupplyMv(5_000));
    observer.observe(0, Event::ProgramStart(Cause::Power));
    for frame in 0..=17 {
        for servo in 0..=(frame / 5).min(3) {
            let ms = 100 + 20 * frame + 4 * servo;
            observer.observe(ms * MS, pulse(servo as usize));
        }
    }
    assert_eq!(observer.take_verdict(), Ok(()));
    observer
}

/// Returns an observer of a robot whose program hangs at 450 ms. The watchdog resets the processor at 600 ms, and
/// `rest` arrives at `rest_ms`.
fn observer_of_hung_robot(rest_ms: Time) -> Observer {
    let mut observer = observer_of_awake_robot();
    let mut events = [
        (450, Event::MainStalled(605 * MS)),
        (600, Event::ProgramStart(Cause::Watchdog)),
        (rest_ms, accepted_command(Effect::Rest)),
    ];
    events.sort_by_key(|(ms, _)| *ms);
    for (ms, event) in events {
        observer.observe(ms * MS, event);
    }
    observer
}

fn take_violated_rules(observer: &mut Observer) -> Vec<Rule> {
    let violations = observer.take_violations().into_iter();
    violations.map(|violation| violation.rule).collect()
}

#[test]
fn a_rest_in_or_soon_after_a_hang_does_not_forbid_the_pulses_of_the_next_frame() {
    for rest_ms in [500, 620] {
        let mut observer = observer_of_hung_robot(rest_ms);
        observe_pulses_of_all_servos(&mut observer, 625);
        let violated_rules = take_violated_rules(&mut observer);
        assert_eq!(violated_rules, [], "rest at {rest_ms} ms");
    }
}

#[test]
fn servos_that_rested_after_a_hang_must_wake_one_by_one() {
    let mut observer = observer_of_hung_robot(620);
    observer.observe(740 * MS, accepted_command(Effect::Motion));
    observe_pulses_of_all_servos(&mut observer, 825);
    assert_eq!(take_violated_rules(&mut observer), [Rule::WakeOneByOne; 3]);
}

#[test]
fn only_a_gap_caused_by_blocked_interrupts_does_not_count_as_a_wake_up() {
    for (are_interrupts_blocked, expected) in [(true, &[][..]), (false, &[Rule::WakeOneByOne])] {
        let mut observer = observer_of_awake_robot();
        if are_interrupts_blocked {
            observer.observe(455 * MS, Event::InterruptsBlocked(457 * MS));
        }
        // A2's pulse of the frame at 460 ms is missing; A4 woke at 412 ms.
        observer.observe(460 * MS, pulse(0));
        observer.observe(484 * MS, pulse(1));
        let violated_rules = take_violated_rules(&mut observer);
        assert_eq!(
            violated_rules, expected,
            "interrupts blocked: {are_interrupts_blocked}"
        );
    }
}

#[test]
fn servos_without_pulses_long_after_blocked_interrupts_must_wake_one_by_one() {
    let mut observer = observer_of_awake_robot();
    observer.observe(455 * MS, Event::InterruptsBlocked(457 * MS));
    observe_pulses_of_all_servos(&mut observer, 540);
    assert_eq!(take_violated_rules(&mut observer), [Rule::WakeOneByOne; 3]);
}

#[test]
fn new_settings_at_rest_do_not_allow_a_servo_to_wake_with_a_jump() {
    let mut observer = observer_of_awake_robot();
    observer.limits.max_change_cycles = [100; 4];
    observer.observe(450 * MS, accepted_command(Effect::Rest));
    observer.observe(600 * MS, Event::CalibrationChanged { is_saved: false });
    observer.observe(700 * MS, accepted_command(Effect::Motion));
    observer.observe(800 * MS, Event::Pulse(Pulse::exact(0, 25_000)));
    assert_eq!(take_violated_rules(&mut observer), [Rule::SlewLimit]);
}

#[test]
fn a_rest_report_that_may_have_been_queued_before_a_command_does_not_forbid_its_pulses() {
    for (printed_from_ms, expected) in [(640, &[][..]), (700, &[Rule::PulsesPermitted])] {
        let mut observer = observer_of_awake_robot();
        observer.observe(450 * MS, Event::ProgramCut);
        observer.observe(455 * MS, Event::ProgramStart(Cause::BrownOut));
        observer.observe(530 * MS, accepted_command(Effect::Motion));
        let report = Event::LinePrinted(printed_from_ms * MS, REPEATED_RESETS_REPORT);
        observer.observe(710 * MS, report);
        observer.observe(760 * MS, pulse(0));
        let violated_rules = take_violated_rules(&mut observer);
        assert_eq!(
            violated_rules, expected,
            "printed from {printed_from_ms} ms"
        );
    }
}
