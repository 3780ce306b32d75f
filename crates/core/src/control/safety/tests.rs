//! Every fault, alone and with others.

use super::*;
use crate::sample::{HEALTHY, Sample};

fn supplies() -> Supplies {
    Sample::odd().supplies()
}

/// The state after power-on, with `boot` cancelled.
fn without_boot() -> Safety {
    let mut safety = Safety::default();
    safety.note_byte();
    safety
}

fn frame(safety: &mut Safety, health: &Health) -> Reaction {
    safety.check_frame(health, &supplies(), State::Still, 0)
}

/// The health of a board whose chip has a supply of this many volts and whose rail has 6 V.
fn health_at(volts: f64) -> Health {
    Health {
        supply: Reading {
            reference: (1.08 / volts * 1024.0) as u16,
            rail: (6.0 / 3.378 * 1.08 / volts * 1024.0) as u16,
        },
        ..HEALTHY
    }
}

/// Takes all pending notices.
fn notices(safety: &mut Safety) -> std::vec::Vec<Notice> {
    let mut printed = std::vec::Vec::new();
    while let Some(notice) = safety.notice() {
        safety.note_printed(notice);
        printed.push(notice);
    }
    printed
}

#[test]
fn while_all_is_well_no_reaction_and_no_notice_follows() {
    let mut safety = without_boot();
    for _ in 0..1000 {
        assert_eq!(frame(&mut safety, &HEALTHY), Reaction::None);
    }
    assert_eq!(safety.fault(), None);
    assert_eq!(safety.notice(), None);
    assert!(!safety.is_slow() && safety.allows_writing());
}

#[test]
fn before_the_supply_has_been_measured_a_robot_may_move_but_not_write() {
    let mut safety = without_boot();
    for _ in 0..20 {
        frame(&mut safety, &Health::default());
        assert!(!safety.allows_writing());
        assert_eq!(
            safety.response(Event::Save, State::Still),
            Response::Obey,
            "it waits"
        );
        assert_eq!(safety.response(Event::Move, State::Still), Response::Obey);
    }
    // Here, too, a single reading decides nothing: it takes six.
    for _ in 0..5 {
        frame(&mut safety, &HEALTHY);
        assert!(!safety.allows_writing());
    }
    frame(&mut safety, &HEALTHY);
    assert!(safety.allows_writing());
}

#[test]
fn boot_is_requested_once_three_seconds_after_power_on() {
    let mut safety = Safety::default();
    for number in 1..=1000 {
        let order = frame(&mut safety, &HEALTHY);
        let expected = if number == 150 {
            Reaction::Boot
        } else {
            Reaction::None
        };
        assert_eq!(order, expected, "{number}");
    }
}

#[test]
fn a_byte_a_fault_or_a_low_supply_cancels_boot() {
    let boots = |disturb: fn(&mut Safety)| {
        let mut safety = Safety::default();
        let mut booted = false;
        for number in 1..=400 {
            booted |= frame(&mut safety, &HEALTHY) == Reaction::Boot;
            if number == 100 {
                disturb(&mut safety);
            }
        }
        booted
    };
    assert!(boots(|_| {}));
    assert!(!boots(Safety::note_byte));
    assert!(!boots(|safety| safety.record_fault(Fault::Late)));
    assert!(!boots(|safety| {
        for _ in 0..6 {
            frame(safety, &health_at(4.2));
        }
        safety.clear_fault();
    }));
}

#[test]
fn a_gait_ends_when_no_line_has_come_for_as_long_as_deadman_says_and_no_sooner() {
    let supplies = supplies();
    for deadman in [1u16, 19, 20, 21, 100, 1000, 60_000] {
        let mut safety = without_boot();
        for _ in 0..10 {
            safety.note_command();
            let mut frames = 0;
            while safety.check_frame(&HEALTHY, &supplies, State::Walking, deadman) == Reaction::None
            {
                frames += 1;
            }
            // If the command came just before the first frame, these are the times since it, ms: in the last frame,
            // which ended the gait, and in the previous one.
            let (min, before) = (20 * frames, 20 * frames - 20);
            assert!(
                min >= u32::from(deadman) && before < u32::from(deadman),
                "{frames}"
            );
            assert_eq!(safety.fault(), Some(Fault::Link));
            safety.clear_fault();
        }
    }
}

#[test]
fn without_deadman_or_gait_silence_is_no_fault() {
    let mut safety = without_boot();
    let supplies = supplies();
    for _ in 0..5000 {
        for (state, deadman) in [
            (State::Walking, 0),
            (State::Still, 20),
            (State::Resting, 20),
        ] {
            let reaction = safety.check_frame(&HEALTHY, &supplies, state, deadman);
            assert_eq!(reaction, Reaction::None);
        }
    }
}

#[test]
fn boot_begins_a_gait_that_no_line_ends_before_deadman_has_passed() {
    let mut safety = Safety::default();
    let mut state = State::Still;
    let mut booted = 0;
    for number in 1..400 {
        match safety.check_frame(&HEALTHY, &supplies(), state, 1000) {
            Reaction::Boot => (state, booted) = (State::Walking, number),
            Reaction::None => {}
            other => {
                assert_eq!(other, Reaction::Freeze);
                assert_eq!((booted, number), (150, 150 + 51));
                return;
            }
        }
    }
    panic!("it never ends");
}

#[test]
fn a_falling_supply_stops_then_ends_the_pulses_and_forbids_writing_first() {
    let mut safety = without_boot();
    let mut run = |volts| {
        let orders = [(); 6].map(|()| frame(&mut safety, &health_at(volts)));
        (
            orders[5],
            safety.fault(),
            safety.response(Event::Move, State::Still) == Response::Obey,
            safety.allows_writing(),
            notices(&mut safety).len(),
        )
    };
    let supply = Some(Fault::Supply);
    assert_eq!(run(4.4), (Reaction::None, None, true, false, 1));
    assert_eq!(run(4.2), (Reaction::Freeze, supply, false, false, 2));
    assert_eq!(run(4.0), (Reaction::EndPulses, supply, false, false, 2));
}

#[test]
fn each_late_edge_stops_the_robot_and_is_reported() {
    let mut safety = without_boot();
    for late in [1, 2, 7, 65_535] {
        let health = Health {
            late_edges: late,
            ..HEALTHY
        };
        assert_eq!(frame(&mut safety, &health), Reaction::Freeze);
        assert_eq!(safety.fault(), Some(Fault::Late));
        assert_eq!(notices(&mut safety), [Notice::Fault]);
        assert_eq!(frame(&mut safety, &health), Reaction::None, "once");
    }
}

#[test]
fn a_stack_in_the_data_stops_and_goes_on_doing_so_after_every_motion() {
    let mut safety = without_boot();
    let health = Health {
        is_stack_intact: false,
        ..HEALTHY
    };
    for _ in 0..3 {
        assert_eq!(frame(&mut safety, &health), Reaction::Freeze);
        assert_eq!(safety.fault(), Some(Fault::Stack));
        for _ in 0..100 {
            assert_eq!(frame(&mut safety, &health), Reaction::None);
        }
        safety.clear_fault();
    }
}

#[test]
fn of_two_reactions_at_once_the_stronger_one_counts() {
    let mut safety = without_boot();
    for _ in 0..5 {
        frame(&mut safety, &health_at(4.0));
    }
    let health = Health {
        late_edges: 1,
        ..health_at(4.0)
    };
    assert_eq!(frame(&mut safety, &health), Reaction::EndPulses);
}

#[test]
fn notices_come_once_each_and_in_a_fixed_order() {
    let mut safety = without_boot();
    for notice in [
        Notice::Boot,
        Notice::Memory,
        Notice::Supply,
        Notice::Fault,
        Notice::NotKept,
        Notice::Boot,
    ] {
        safety.notify(notice);
    }
    let expected = [
        Notice::Memory,
        Notice::NotKept,
        Notice::Fault,
        Notice::Supply,
        Notice::Boot,
    ];
    assert_eq!(notices(&mut safety), expected);
}
