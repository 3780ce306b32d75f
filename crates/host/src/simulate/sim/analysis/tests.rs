//! Tests of the results computed from synthetic frames.

use super::*;
use crate::shared::robot_args::built_in_robot;

/// Creates a log of frames with the pulses for `angles_at(seconds)`, where `seconds` counts from the first frame. The
/// first frame starts 1 s after power-on.
fn create_log(robot: &Robot, frame_count: u64, angles_at: impl Fn(f64) -> [f64; 4]) -> FrameLog {
    let to_width = |i: usize, angle: f64| {
        let us = robot.servos()[i].pulse(angle);
        (us * CYCLES_PER_US as f64).round() as u16
    };
    let compute_widths = |n: u64| {
        let angles = angles_at(n as f64 / 50.0);
        std::array::from_fn(|i| to_width(i, angles[i]))
    };
    FrameLog::new(FREQUENCY, (0..frame_count).map(compute_widths).collect())
}

fn create_gait_log(robot: &Robot, name: &str, frame_count: u64) -> FrameLog {
    let gait = robot.gait(name).expect("the gait is in robot.toml");
    create_log(robot, frame_count, |seconds| {
        gait.angles(gait.phase_at(seconds))
    })
}

#[test]
fn an_angle_survives_the_conversion_to_a_pulse_and_back() {
    let robot = built_in_robot("paper");
    let pose = [120.0, 45.0, 300.0, 230.0];
    let log = create_log(&robot, 2, |_| pose);
    let first_frame = Run::new(&robot, &log).servo_frames().next();
    let first_frame = first_frame.expect("the log has two frames");
    let angles = first_frame.angles.expect("all four servos have a pulse");
    for (angle, expected) in angles.into_iter().zip(pose) {
        // A width is rounded by at most half a cycle of 62.5 ns; a degree is 10 us.
        assert!((angle - expected).abs() <= 0.0032, "{angle} {expected}");
    }
    assert_eq!(first_frame.seconds, 1.0);
}

#[test]
fn displacements_of_walk_back_and_left_match_their_predictions() {
    let robot = built_in_robot("paper");
    for (gait, forward, turn) in [
        ("walk", 34.16, 0.0),
        ("left", 0.0, 15.34),
        ("back", -34.16, 0.0),
    ] {
        let log = create_gait_log(&robot, gait, 51);
        let span = Span::new(gait, 0.0, 10.0);
        let displacements = compute_command_displacements(Run::new(&robot, &log), &[span]);
        let total = displacements.last().expect("the run has a displacement");
        let is_close = |actual: Option<f64>, expected: f64, tolerance: f64| {
            actual.is_some_and(|actual| (actual - expected).abs() < tolerance)
        };
        let is_forward_close = is_close(total.displacement.forward, forward, 0.35);
        assert!(is_forward_close, "{gait}: {total:?}");
        let is_turn_close = is_close(total.displacement.turn, turn, 0.2);
        assert!(is_turn_close, "{gait}: {total:?}");
    }
}

#[test]
fn the_displacement_is_undetermined_while_two_feet_pull_against_two() {
    let robot = built_in_robot("paper");
    let log = create_gait_log(&robot, "look", 100);
    let spans = [Span::new("stand", 0.0, 1.0), Span::new("look", 1.0, 3.0)];
    let displacements = compute_command_displacements(Run::new(&robot, &log), &spans);
    let forward = displacements.iter().map(|row| row.displacement.forward);
    let are_determined: Vec<bool> = forward.map(|forward| forward.is_some()).collect();
    assert_eq!(are_determined, [true, false, false], "{displacements:?}");
}

#[test]
fn displacements_of_two_commands_compose_to_that_of_the_run() {
    let robot = built_in_robot("paper");
    for gait in ["arc-left", "right"] {
        let log = create_gait_log(&robot, gait, 400);
        let run = Run::new(&robot, &log);
        let spans = [Span::new(gait, 0.0, 3.0), Span::new(gait, 3.0, 20.0)];
        let displacements = compute_command_displacements(run, &spans);
        let sweeps = run.servo_frames().filter_map(|frame| frame.sweeps);
        let total_travel = robot.ground().compute_travel(sweeps);
        let [first, second, total] = &displacements[..] else {
            panic!("expected rows of two commands and of the run: {displacements:?}")
        };
        let to_travel = |row: &CommandDisplacement| {
            let components = row.displacement.components();
            let [forward, left, turn] =
                components.map(|component| component.expect("it is determined"));
            Travel {
                forward,
                left,
                turn,
            }
        };
        let distance_between = |a: Travel, b: Travel| {
            (a.forward - b.forward).hypot(a.left - b.left) + (a.turn - b.turn).abs()
        };
        let distance = distance_between(to_travel(total), total_travel);
        assert!(distance < 1e-6, "{total:?} {total_travel:?}");
        let combined = compose_travel(to_travel(first), to_travel(second));
        assert!(distance_between(to_travel(total), combined) < 1e-6);
    }
}

#[test]
fn servo_reports_have_pulse_widths_slew_rates_and_errors() {
    let robot = built_in_robot("paper");
    let mut log = create_log(&robot, 3, |seconds| {
        let mut angles: [f64; 4] = robot.neutral_pose().into();
        angles[0] += 100.0 * seconds;
        angles
    });
    log.max_period_error[1] = 7;
    log.widths[1][2] -= 3;
    let commands = [0, 320, 640].map(|extra| [24_000 + extra, 24_000, 24_000, 24_000]);
    let reports = compute_servo_reports(Run::new(&robot, &log), Some(&commands));
    let a1 = &reports[0];
    assert_eq!((a1.pulse_count, a1.min_us, a1.max_us), (3, 1500.0, 1540.0));
    assert!((a1.slew - 100.0).abs() < 0.5);
    let errors = reports
        .iter()
        .map(|report| (report.width_error, report.period_error));
    let expected = [(Some(0), 0), (Some(0), 7), (Some(3), 0), (Some(0), 0)];
    assert_eq!(errors.collect::<Vec<_>>(), expected);
}

#[test]
fn a_pose_near_a_singularity_is_a_violation() {
    let robot = built_in_robot("paper");
    let check_log = |log: &FrameLog| check_safety(Run::new(&robot, log));
    let walk_safety = check_log(&create_gait_log(&robot, "walk", 50));
    assert_eq!(walk_safety.violation_count, 0);
    assert!(walk_safety.min_margin.is_some_and(|min| min.value > 0.3));
    let singular_safety = check_log(&create_log(&robot, 2, |_| [90.0, 90.0, 318.59, 221.41]));
    assert_eq!(singular_safety.violation_count, 2);
    assert!(singular_safety.first_violation.is_some());
}
