//! Tests of every fault, alone and together with other faults.

use super::*;
use crate::sample::{HEALTHY_BOARD, Sample};

fn sample_supplies() -> Supplies {
    Sample::asymmetric().supplies()
}

/// Returns a monitor after power-on whose `boot` is cancelled.
fn safety_without_boot() -> Safety {
    let mut safety = Safety::new();
    safety.record_byte();
    safety
}

/// Checks a frame of a robot that stands still and has no `deadman` time.
fn check_still_frame(safety: &mut Safety, health: &Health) -> Reaction {
    safety.check_frame(health, &sample_supplies(), State::Posing, 0)
}

/// Returns the health of a board whose chip is supplied with `volts`, and whose servo rail has 6 V.
fn health_at_volts(volts: f64) -> Health {
    Health {
        supply: Reading {
            reference: (1.08 / volts * 1024.0) as u16,
            rail: (6.0 / 3.378 * 1.08 / volts * 1024.0) as u16,
        },
        ..HEALTHY_BOARD
    }
}

/// Takes all pending notices.
fn take_notices(safety: &mut Safety) -> std::vec::Vec<Notice> {
    let mut notices = std::vec::Vec::new();
    while let Some(notice) = safety.next_notice() {
        safety.clear_notice(notice);
        notices.push(notice);
    }
    notices
}

#[test]
fn a_healthy_board_causes_neither_a_reaction_nor_a_notice() {
    let mut safety = safety_without_boot();
    for _ in 0..1000 {
        let reaction = check_still_frame(&mut safety, &HEALTHY_BOARD);
        assert_eq!(reaction, Reaction::None);
    }
    assert_eq!(safety.fault(), None);
    assert_eq!(safety.next_notice(), None);
    assert!(!safety.is_slow() && safety.allows_writing());
}

#[test]
fn before_the_supply_has_been_measured_a_robot_may_move_but_not_write() {
    let mut safety = safety_without_boot();
    let unmeasured_board = Health {
        supply: Reading::default(),
        ..HEALTHY_BOARD
    };
    for _ in 0..20 {
        check_still_frame(&mut safety, &unmeasured_board);
        assert!(!safety.allows_writing());
        let response = safety.response(Event::Save, State::Posing);
        let claim = "the write waits for the measurement";
        assert_eq!(response, Response::Obey, "{claim}");
        assert_eq!(safety.response(Event::Move, State::Posing), Response::Obey);
    }
    // Writing is allowed after six readings.
    for _ in 0..5 {
        check_still_frame(&mut safety, &HEALTHY_BOARD);
        assert!(!safety.allows_writing());
    }
    check_still_frame(&mut safety, &HEALTHY_BOARD);
    assert!(safety.allows_writing());
}

#[test]
fn boot_is_requested_once_three_seconds_after_power_on() {
    let mut safety = Safety::new();
    for frame in 1..=1000 {
        let reaction = check_still_frame(&mut safety, &HEALTHY_BOARD);
        let expected_reaction = match frame {
            150 => Reaction::Boot,
            _ => Reaction::None,
        };
        assert_eq!(reaction, expected_reaction, "{frame}");
    }
}

#[test]
fn a_byte_a_fault_or_a_low_supply_cancels_boot() {
    let boots_despite = |disturb: fn(&mut Safety)| {
        let mut safety = Safety::new();
        let mut has_booted = false;
        for frame in 1..=400 {
            has_booted |= check_still_frame(&mut safety, &HEALTHY_BOARD) == Reaction::Boot;
            if frame == 100 {
                disturb(&mut safety);
            }
        }
        has_booted
    };
    assert!(boots_despite(|_| {}));
    assert!(!boots_despite(Safety::record_byte));
    assert!(!boots_despite(|safety| safety.record_fault(Fault::LateEdge)));
    assert!(!boots_despite(|safety| {
        for _ in 0..6 {
            check_still_frame(safety, &health_at_volts(4.2));
        }
        safety.clear_fault();
    }));
}

#[test]
fn a_gait_without_a_command_ends_after_the_deadman_time_and_no_sooner() {
    let supplies = sample_supplies();
    for deadman_ms in [1u16, 19, 20, 21, 100, 1000, 60_000] {
        let mut safety = safety_without_boot();
        for _ in 0..10 {
            safety.record_command();
            let mut frames = 0;
            while safety.check_frame(&HEALTHY_BOARD, &supplies, State::Walking, deadman_ms)
                == Reaction::None
            {
                frames += 1;
            }
            // The times since a command just before the first frame, ms: in the last frame, which ended the gait, and
            // in the previous frame.
            let last_ms = 20 * frames;
            let previous_ms = last_ms - 20;
            assert!(last_ms >= deadman_ms, "{frames}");
            assert!(previous_ms < deadman_ms, "{frames}");
            assert_eq!(safety.fault(), Some(Fault::Link));
            safety.clear_fault();
        }
    }
}

#[test]
fn silence_without_deadman_or_without_a_gait_is_not_a_fault() {
    let mut safety = safety_without_boot();
    let supplies = sample_supplies();
    for _ in 0..5000 {
        for (state, deadman_ms) in [
            (State::Walking, 0),
            (State::Posing, 20),
            (State::Resting, 20),
        ] {
            let reaction = safety.check_frame(&HEALTHY_BOARD, &supplies, state, deadman_ms);
            assert_eq!(reaction, Reaction::None);
        }
    }
}

#[test]
fn a_gait_started_by_boot_ends_only_after_the_deadman_time() {
    let mut safety = Safety::new();
    let mut state = State::Posing;
    let mut boot_frame = 0;
    for frame in 1..400 {
        match safety.check_frame(&HEALTHY_BOARD, &sample_supplies(), state, 1000) {
            Reaction::Boot => (state, boot_frame) = (State::Walking, frame),
            Reaction::None => {}
            reaction => {
                assert_eq!(reaction, Reaction::Freeze);
                assert_eq!((boot_frame, frame), (150, 150 + 51));
                return;
            }
        }
    }
    panic!("the gait never ends");
}

#[test]
fn a_falling_supply_first_forbids_writing_then_stops_the_robot_then_ends_the_pulses() {
    let mut safety = safety_without_boot();
    // Returns the reaction and the fault after six frames, true if the robot may move, true if the EEPROM may be
    // written, and the number of notices.
    let mut observe_at = |volts| {
        let reactions = [(); 6].map(|()| check_still_frame(&mut safety, &health_at_volts(volts)));
        (
            reactions[5],
            safety.fault(),
            safety.response(Event::Move, State::Posing) == Response::Obey,
            safety.allows_writing(),
            take_notices(&mut safety).len(),
        )
    };
    let supply_fault = Some(Fault::Supply);
    for (volts, expected) in [
        (4.4, (Reaction::None, None, true, false, 1)),
        (4.2, (Reaction::Freeze, supply_fault, false, false, 2)),
        (4.0, (Reaction::EndPulses, supply_fault, false, false, 2)),
    ] {
        assert_eq!(observe_at(volts), expected, "{volts} V");
    }
}

#[test]
fn each_late_edge_stops_the_robot_and_is_reported() {
    let mut safety = safety_without_boot();
    for late_edges in [1, 2, 7, 65_535] {
        let health = Health {
            late_edges,
            ..HEALTHY_BOARD
        };
        assert_eq!(check_still_frame(&mut safety, &health), Reaction::Freeze);
        assert_eq!(safety.fault(), Some(Fault::LateEdge));
        assert_eq!(take_notices(&mut safety), [Notice::Fault]);
        let reaction = check_still_frame(&mut safety, &health);
        assert_eq!(reaction, Reaction::None, "each edge is handled once");
    }
}

#[test]
fn a_stack_in_the_data_stops_the_robot_again_after_every_cleared_fault() {
    let mut safety = safety_without_boot();
    let health = Health {
        is_stack_intact: false,
        ..HEALTHY_BOARD
    };
    for _ in 0..3 {
        assert_eq!(check_still_frame(&mut safety, &health), Reaction::Freeze);
        assert_eq!(safety.fault(), Some(Fault::Stack));
        for _ in 0..100 {
            assert_eq!(check_still_frame(&mut safety, &health), Reaction::None);
        }
        safety.clear_fault();
    }
}

#[test]
fn the_stronger_of_two_simultaneous_reactions_counts() {
    let mut safety = safety_without_boot();
    for _ in 0..5 {
        check_still_frame(&mut safety, &health_at_volts(4.0));
    }
    let health = Health {
        late_edges: 1,
        ..health_at_volts(4.0)
    };
    assert_eq!(check_still_frame(&mut safety, &health), Reaction::EndPulses);
}

#[test]
fn each_notice_is_printed_once_and_in_a_fixed_order() {
    use Notice::{Boot, Fault, RestPoseNotSaved, SavedSettings, Supply};
    let mut safety = safety_without_boot();
    for notice in [Boot, SavedSettings, Supply, Fault, RestPoseNotSaved, Boot] {
        safety.notify(notice);
    }
    let expected_notices = [SavedSettings, RestPoseNotSaved, Fault, Supply, Boot];
    assert_eq!(take_notices(&mut safety), expected_notices);
}
