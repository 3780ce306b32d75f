//! Properties of every robot in robots/, and of the builder's own robot, robot.toml.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use lizard_kinematics::Check;
use lizard_robot::{CheckedGait, Robot, STEPS_PER_DEGREE};

/// Lists the files in robots/, and robot.toml.
fn list_files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = std::fs::read_dir(root.join("robots")).expect("robots/ can be read");
    let mut files: Vec<PathBuf> = folder
        .map(|entry| entry.expect("the entry can be read").path())
        .collect();
    assert!(files.len() >= 4, "{files:?}");
    files.push(root.join("robot.toml"));
    files
}

/// Runs a test for every robot, with the path of its file.
fn for_each_robot(test: impl Fn(&str, &Robot)) {
    static ROBOTS: LazyLock<Vec<(String, Robot)>> = LazyLock::new(|| {
        let load = |file: PathBuf| {
            let robot = Robot::load(&file).unwrap_or_else(|error| panic!("{error}"));
            (file.display().to_string(), robot)
        };
        list_files().into_iter().map(load).collect()
    });
    for (file, robot) in ROBOTS.iter() {
        test(file, robot);
    }
}

/// Runs a test for every gait of every robot, with a label of the robot's file and the gait.
fn for_each_gait(test: impl Fn(&str, &Robot, &CheckedGait)) {
    for_each_robot(|file, robot| {
        for gait in robot.gaits() {
            test(&format!("{file} {}", gait.name()), robot, gait);
        }
    });
}

#[test]
fn table_errors_are_at_most_half_a_degree() {
    for_each_gait(|label, _, gait| {
        let error = gait.table_error();
        assert!(error.max <= 0.50, "{label}: {error:?}");
        assert!(error.rms <= error.max);
    });
}

#[test]
fn every_gait_is_also_safe_between_its_samples() {
    for_each_gait(|label, robot, gait| {
        for phase in (0..=u16::MAX).step_by(7) {
            let pose = gait.table_angles(phase).into();
            let solution = robot.lizard().solve(&pose).expect("the linkage closes");
            if let Some(violation) = robot.limits().violations(&solution).next() {
                // The check samples 1024 phases. Between two samples, a margin changes by less than 0.01.
                let excess = (violation.value - violation.limit).abs();
                assert!(excess < 0.01, "{label} at {phase}: {violation}");
            }
        }
    });
}

#[test]
fn an_audit_contains_the_smallest_margins_of_all_phases() {
    for_each_gait(|label, robot, gait| {
        let audit = gait.audit();
        let mut min_margins = [f64::INFINITY; 3];
        let (mut min_sampled_stroke, mut max_sampled_stroke) = (f64::INFINITY, f64::NEG_INFINITY);
        for phase in (0..=u16::MAX).step_by(64) {
            let pose = gait.table_angles(phase).into();
            let solution = robot.lizard().solve(&pose).expect("the linkage closes");
            let margins = &solution.margins;
            let margins = [&margins.type2[..], &margins.type1, &margins.leg];
            for (min_margin, margins) in min_margins.iter_mut().zip(margins) {
                *min_margin = margins.iter().fold(*min_margin, |a, b| a.min(*b));
            }
            for stroke in [solution.left.s, solution.right.s] {
                min_sampled_stroke = min_sampled_stroke.min(stroke);
                max_sampled_stroke = max_sampled_stroke.max(stroke);
            }
        }
        let audited_margins = [audit.type2.value, audit.type1.value, audit.leg.value];
        for (audited, sampled) in audited_margins.into_iter().zip(min_margins) {
            // The audit samples more phases than this test, so its minimum may be smaller.
            assert!((0.0..0.002).contains(&(sampled - audited)), "{label}");
        }
        let (min_stroke, max_stroke) = audit.stroke_range;
        let differences = [
            min_sampled_stroke - min_stroke,
            max_stroke - max_sampled_stroke,
        ];
        for difference in differences {
            assert!((0.0..0.1).contains(&difference), "{label}");
        }
        assert!(Check::TYPE2.contains(&audit.type2.check), "{label}");
    });
}

#[test]
fn the_peak_speed_is_the_highest_in_either_direction() {
    for_each_gait(|label, robot, gait| {
        let phase_per_frame = 0.02 / gait.period();
        let mut max_speed = 0.0f64;
        for i in 0..1000 {
            let phase = f64::from(i) / 1000.0;
            let (angles, next_angles) = (gait.angles(phase), gait.angles(phase + phase_per_frame));
            for servo in 0..4 {
                max_speed = max_speed.max((next_angles[servo] - angles[servo]).abs() * 50.0);
            }
        }
        let peak = gait.audit().peak_speed;
        let is_near = (peak.speed - max_speed).abs() <= 0.005 * max_speed;
        assert!(is_near, "{label}: {peak:?}, expected {max_speed} deg/s");
        assert!(peak.speed <= robot.speed_limits().gait_slew);
    });
}

#[test]
fn stand_is_exactly_the_neutral_pose() {
    for_each_robot(|file, robot| {
        let stand = &robot.gaits()[0];
        let properties = (stand.name(), stand.has_movement());
        assert_eq!(properties, ("stand", false), "{file}");
        for phase in 0..=u16::MAX {
            assert_eq!(stand.table_sweeps(phase), [0; 4]);
        }
        assert_eq!(stand.pose(0.3), robot.neutral_pose());
    });
}

#[test]
fn gaits_are_found_by_name_and_stay_within_the_servos_pulse_range() {
    for_each_gait(|label, robot, gait| {
        assert_eq!(robot.gaits().get(gait.index()), Some(gait), "{label}");
        let console_name = gait.name().replace('-', " ");
        assert_eq!(robot.gait(&console_name), Some(gait), "{label}");
        for phase in (0..=u16::MAX).step_by(64) {
            for (servo, sweep) in robot.servos().iter().zip(gait.table_sweeps(phase)) {
                let change = servo.us_per_degree * f64::from(sweep) / STEPS_PER_DEGREE;
                let pulse = servo.neutral_us + change;
                // Sweeps and the limits of the travel are rounded to a step, up to a tenth of a microsecond.
                let is_within = pulse > servo.min_us - 0.2 && pulse < servo.max_us + 0.2;
                assert!(is_within, "{label} at {phase}: {pulse} us");
            }
        }
    });
}

#[test]
fn sweeps_are_zero_at_neutral_and_positive_if_the_feet_are_forward() {
    for_each_robot(|file, robot| {
        let neutral_angles: [f64; 4] = robot.neutral_pose().into();
        assert_eq!(robot.sweeps(neutral_angles), [0.0; 4], "{file}");
        // If the feet move forward, theta1 and theta5 decrease, and theta4 and theta8 increase.
        let forward_change_deg = [-3.0, 3.0, 3.0, -3.0];
        let angles = std::array::from_fn(|i| neutral_angles[i] + forward_change_deg[i]);
        for sweep in robot.sweeps(angles) {
            assert!((sweep - 3.0).abs() < 1e-9, "{file}");
        }
    });
}
