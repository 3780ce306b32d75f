//! Asks a robot for its calibration, and gives it one.

use std::io::{Read, Write};

use lizard_robot::{Calibration, Transfer};

use super::link::{Link, LinkError};

/// Asks a robot for its settings.
///
/// # Errors
/// Fails if there is no answer, or one that is not understood.
pub fn ask<P: Read + Write>(link: &mut Link<P>) -> Result<Calibration, LinkError> {
    let reply = link.command("cal")?;
    Calibration::from_lines(&reply.notes).ok_or_else(|| LinkError::Unclear {
        line: "cal".to_owned(),
        answer: reply.notes.join(" / "),
    })
}

/// Gives a robot settings, unsaved, in the order of a [`Transfer`].
///
/// # Errors
/// Fails if the connection breaks, or if lines are still refused in the last round: returns the first refusal of
/// that round. The robot then has a part of the settings.
pub fn apply<P: Read + Write>(
    calibration: &Calibration,
    link: &mut Link<P>,
) -> Result<(), LinkError> {
    let mut transfer = Transfer::new(calibration);
    let mut refusal = None;
    while let Some(line) = transfer.next_line() {
        match link.command(&line) {
            Ok(_) => {}
            Err(error @ LinkError::Refused { .. }) => {
                if transfer.refuse() {
                    refusal = Some(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
    let remaining = refusal.filter(|_| !transfer.is_done());
    remaining.map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::super::double::{PAPER, connect_paper_robot, connect_robot};
    use super::*;

    /// The calibration that the simulated robot starts with.
    fn factory_settings() -> Calibration {
        ask(&mut connect_paper_robot()).expect("it answers")
    }

    #[test]
    fn the_settings_of_a_new_robot_are_those_of_robot_toml() {
        let calibration = factory_settings();
        assert_eq!(calibration.boot, "stand");
        assert_eq!(calibration.deadman, 0);
        for (servo, neutral) in calibration
            .servos
            .iter()
            .zip([138.59, 41.41, 318.59, 221.41])
        {
            assert_eq!((servo.trim, servo.dir, servo.scale), (0.0, '+', 10.0));
            let min = (neutral - 90.0_f64).rem_euclid(360.0);
            assert!((servo.limit[0] - min).abs() < 0.011, "{servo:?}");
        }
    }

    #[test]
    fn settings_that_were_sent_are_read_back() {
        let mut link = connect_paper_robot();
        let mut calibration = factory_settings();
        calibration.servos[1].trim = -3.25;
        calibration.servos[2].dir = '-';
        calibration.servos[3].scale = 10.57;
        calibration.servos[0].limit = [70.0, -150.0];
        calibration.boot = "arc left".to_owned();
        calibration.deadman = 1500;
        apply(&calibration, &mut link).expect("it takes them");
        let read_back = ask(&mut link).expect("it answers");
        assert!(calibration.is_same(&read_back), "{read_back:?}");
        assert!(!calibration.is_same(&factory_settings()));
    }

    #[test]
    fn a_setting_that_the_current_ones_forbid_is_retried_after_the_others() {
        // With a travel of 400 us to each side, a large trim and a large scale exclude each other.
        let narrow_robot = PAPER.replace("min_us = 600.0", "min_us = 1100.0");
        let narrow_robot = narrow_robot.replace("max_us = 2400.0", "max_us = 1900.0");
        let mut link = connect_robot(&narrow_robot);
        let initial = ask(&mut link).expect("it answers");
        let [mut scaled, mut trimmed] = [initial.clone(), initial];
        scaled.servos[0].scale = 16.0;
        trimmed.servos[0].trim = 15.0;
        for calibration in [&trimmed, &scaled, &trimmed] {
            apply(calibration, &mut link).expect("it takes them");
            let read_back = ask(&mut link).expect("it answers");
            assert!(calibration.is_same(&read_back), "{read_back:?}");
        }
    }

    #[test]
    fn settings_that_do_not_suit_the_gaits_are_refused_with_the_robots_reason() {
        let mut link = connect_paper_robot();
        let mut calibration = factory_settings();
        calibration.servos[1].limit = [40.0, 43.0];
        let error = apply(&calibration, &mut link).expect_err("too narrow");
        let message = error.to_string();
        assert!(
            message.contains("`limit 2 40.00 43.00`: 3 A2 would"),
            "{message}"
        );
    }
}
