//! Tests with paths and videos of a servo whose true values are known.

use std::assert_matches;

use fastrand::Rng;
use lizard_contact::BodyPose;
use lizard_studio::render::{Studio, random_normal};
use lizard_studio::servo::{FRICTION_FRACTION, FULL_TORQUE_DEG, Servo};
use lizard_video::{Estimate, Jig, MeasuredServo, PathPoint, ServoError, Setup, Video};

use crate::studio::add_frame;

/// The jig for steps in the counter-clockwise direction.
const JIG: Jig = Jig {
    side: 1.0,
    slew: 1000.0,
    rotor_time_constant: 0.02,
};
/// The load's torque as a fraction of the stall torque: 19.6 N mm of 176.5 N mm.
const LOAD_FRACTION: f64 = 0.111;

/// Simulates the path of a card as its tag would show it to a phone in daylight. Each angle is the mean over the
/// exposure time, plus a random error of the camera. No frame is rendered.
fn simulate_path(frame_rate: f64, servo: &Servo, rng: &mut Rng) -> Vec<PathPoint> {
    const BEGIN_SECONDS: f64 = 0.3;
    const EXPOSURE_SECONDS: f64 = 1.0 / 120.0;
    const ANGLE_SIGMA: f64 = 0.15;
    let horn_angles = servo.simulate(1.0);
    let path_point_at = |i: usize| {
        let seconds = i as f64 / frame_rate + BEGIN_SECONDS;
        let angles = [-0.4, -0.2, 0.0, 0.2, 0.4]
            .map(|fraction| horn_angles.angle_at(seconds + fraction * EXPOSURE_SECONDS));
        let angle = angles.iter().sum::<f64>() / 5.0 + ANGLE_SIGMA * random_normal(rng);
        point_at(seconds, angle)
    };
    let frame_count = (servo.end_s() - BEGIN_SECONDS) * frame_rate;
    (0..frame_count as usize).map(path_point_at).collect()
}

fn point_at(seconds: f64, angle: f64) -> PathPoint {
    PathPoint {
        seconds,
        pose: BodyPose {
            heading: angle.to_radians(),
            ..BodyPose::START
        },
    }
}

fn random_servo(rng: &mut Rng) -> Servo {
    let mut random_between = |low: f64, high: f64| low + (high - low) * rng.f64();
    Servo {
        gain: random_between(0.9, 1.1),
        no_load_rate: random_between(350.0, 700.0),
        rotor_time_constant: random_between(0.012, 0.03),
        dead_band: random_between(0.3, 1.6),
        first_command_s: random_between(0.3, 1.5),
        neutral_heading: random_between(-180.0, 180.0),
        ..Servo::default()
    }
}

/// Returns the fraction of estimates within two standard errors of their true values, and the mean standard error.
fn hit_fraction_and_mean_error(estimates: &[(Estimate, f64)]) -> [f64; 2] {
    let hits = estimates.iter().filter(|(estimate, truth)| {
        (estimate.value - truth).abs() <= 2.0 * estimate.standard_error
    });
    let standard_error = |(estimate, _): &(Estimate, f64)| estimate.standard_error;
    let errors: f64 = estimates.iter().map(standard_error).sum();
    let count = estimates.len() as f64;
    [hits.count() as f64 / count, errors / count]
}

/// Returns the correct width of the dead band that is nearest to the measured width, deg. The controller's own width,
/// increased by up to the effect of the gears' friction, is correct.
fn nearest_dead_band(servo: &Servo, found_width: f64) -> f64 {
    let friction = 2.0 * FRICTION_FRACTION * FULL_TORQUE_DEG;
    found_width.clamp(servo.dead_band, servo.dead_band + friction)
}

/// Returns the measured gain, rate and dead-band width, each with its true value.
fn gain_rate_and_width(measured: &MeasuredServo, servo: &Servo) -> [(Estimate, f64); 3] {
    let width = measured.dead_band.width.expect("the dead band is measured");
    [
        (measured.gain, servo.gain),
        (measured.rate, servo.steady_rate()),
        (width, nearest_dead_band(servo, width.value)),
    ]
}

#[test]
fn over_90_percent_of_estimates_lie_within_two_standard_errors_at_60_to_240_frames_per_second() {
    let mut rng = Rng::with_seed(1);
    for frame_rate in [60.0, 120.0, 240.0] {
        let mut estimates: [Vec<(Estimate, f64)>; 4] = Default::default();
        for _ in 0..60 {
            let servo = random_servo(&mut rng);
            let measured = measure(&simulate_path(frame_rate, &servo, &mut rng));
            let results = gain_rate_and_width(&measured, &servo);
            for (i, estimate) in results.into_iter().enumerate() {
                estimates[i].push(estimate);
            }
            let time_constant = measured.rotor_time_constant;
            estimates[3].extend(time_constant.map(|value| (value, servo.rotor_time_constant)));
        }
        for (i, max_error) in [0.005, 8.0, 0.2, 0.002].into_iter().enumerate() {
            let [hit_fraction, mean_error] = hit_fraction_and_mean_error(&estimates[i]);
            let summary = format!(
                "{frame_rate} frames per second, estimate {i}: within two errors {hit_fraction:.2}, \
                 mean error {mean_error:.4}"
            );
            println!("{summary}");
            assert!(hit_fraction > 0.9 && mean_error < max_error, "{summary}");
        }
        assert!(estimates[3].len() > 30, "{}", estimates[3].len());
    }
}

#[test]
fn a_known_load_gives_the_stall_torque_within_two_standard_errors_in_over_90_percent_of_video_pairs()
 {
    let mut rng = Rng::with_seed(2);
    let video_pair = |rng: &mut Rng| {
        let free = random_servo(rng);
        let loaded = Servo {
            load: LOAD_FRACTION,
            first_command_s: 1.1,
            ..free.clone()
        };
        [free, loaded].map(|servo| measure(&simulate_path(120.0, &servo, rng)))
    };
    let mut stall_torques = Vec::new();
    for _ in 0..30 {
        let [free, loaded] = video_pair(&mut rng);
        let stall_torque = free.compute_stall_torque(&loaded, 19.6);
        let stall_torque = stall_torque.expect("the load slows the servo");
        // The gears' friction reduces the stall torque.
        let truth = 19.6 / LOAD_FRACTION * (1.0 - FRICTION_FRACTION);
        stall_torques.push((stall_torque, truth));
        let swapped = loaded.compute_stall_torque(&free, 19.6);
        assert_eq!(swapped, Err(ServoError::VideosSwapped));
    }
    let [hit_fraction, mean_error] = hit_fraction_and_mean_error(&stall_torques);
    println!("stall torque: within two errors {hit_fraction:.2}, mean error {mean_error:.1} N mm");
    assert!(hit_fraction > 0.9 && mean_error < 25.0);
}

#[test]
fn a_load_that_does_not_slow_the_servo_gives_no_torque() {
    let mut rng = Rng::with_seed(3);
    let [free, loaded] =
        [0, 1].map(|_| measure(&simulate_path(120.0, &Servo::default(), &mut rng)));
    let stall_torque = free.compute_stall_torque(&loaded, 19.6);
    let error = stall_torque.expect_err("the load does not slow the servo");
    let message = error.to_string();
    assert!(message.contains("use a heavier weight"), "{message}");
}

fn measure(path: &[PathPoint]) -> MeasuredServo {
    MeasuredServo::from_path(path, JIG).expect("the servo can be measured")
}

fn expect_error(path: &[PathPoint]) -> ServoError {
    MeasuredServo::from_path(path, JIG).expect_err("the path cannot be measured")
}

#[test]
fn a_servo_that_turns_in_the_opposite_direction_has_a_negative_gain() {
    let servo = Servo {
        gain: -1.05,
        ..Servo::default()
    };
    let gain = measure(&simulate_path(120.0, &servo, &mut Rng::with_seed(4))).gain;
    let deviation = (gain.value + 1.05).abs();
    assert!(deviation < 2.0 * gain.standard_error, "{gain:?}");
}

#[test]
fn a_servo_that_ignores_all_small_steps_has_only_a_largest_ignored_step() {
    let servo = Servo {
        dead_band: 4.0,
        ..Servo::default()
    };
    let dead_band = measure(&simulate_path(60.0, &servo, &mut Rng::with_seed(5))).dead_band;
    assert_eq!(dead_band.width, None);
    assert_eq!(dead_band.largest_ignored_step, 3.0);
}

#[test]
fn a_servo_that_overshoots_its_small_steps_has_no_negative_dead_band() {
    let servo = Servo {
        dead_band: 0.0,
        ..Servo::default()
    };
    let mut path = simulate_path(120.0, &servo, &mut Rng::with_seed(9));
    // The small steps begin 29 s after the first command, at 15 deg from neutral.
    let start = (servo.neutral_heading + 15.0).to_radians();
    for point in &mut path {
        if point.seconds > servo.first_command_s + 28.9 {
            point.pose.heading += 0.5 * (point.pose.heading - start);
        }
    }
    let width = measure(&path).dead_band.width;
    assert_eq!(width.map(|width| width.value), Some(0.0));
}

#[test]
fn a_horn_that_does_not_follow_all_steps_is_rejected_with_the_reason() {
    let mut rng = Rng::with_seed(6);
    let mut angle = 0.0;
    let mut make_path = |turn: fn(f64) -> f64| -> Vec<PathPoint> {
        let times = (0..60 * 55).map(|i| f64::from(i) / 60.0);
        let turned_point_at = |seconds| {
            angle += turn(seconds);
            point_at(seconds, angle)
        };
        times.map(turned_point_at).collect()
    };
    assert_eq!(expect_error(&[]), ServoError::NoTurn { turn: 0.0 });
    let still_path = make_path(|_| 0.0);
    assert_eq!(expect_error(&still_path), ServoError::NoTurn { turn: 0.0 });
    let swaying_path = make_path(f64::sin);
    assert_eq!(expect_error(&swaying_path), ServoError::StepMismatch);
    let complete_path = simulate_path(60.0, &Servo::default(), &mut rng);
    let error = expect_error(&complete_path[..complete_path.len() / 2]);
    assert_matches!(error, ServoError::TooShort { .. });
}

#[test]
fn a_video_in_slow_motion_or_with_few_frames_is_rejected_with_the_reason() {
    let mut rng = Rng::with_seed(7);
    let mut path = simulate_path(240.0, &Servo::default(), &mut rng);
    path.iter_mut().for_each(|point| point.seconds *= 4.0);
    let error = expect_error(&path);
    assert_eq!(error, ServoError::WrongStepInterval { ratio: 4.0 });
    let error = expect_error(&simulate_path(15.0, &Servo::default(), &mut rng));
    assert_matches!(error, ServoError::TooFewFrames { rate } if (rate - 15.0).abs() < 0.1);
    let message = error.to_string();
    assert!(message.contains("record at least 120 frames per second"));
}

#[test]
fn a_slew_limit_below_the_servos_rate_is_reported_instead_of_a_rate() {
    let slew = 300.0;
    let servo = Servo {
        slew_rate: slew,
        ..Servo::default()
    };
    let path = simulate_path(120.0, &servo, &mut Rng::with_seed(8));
    let error = MeasuredServo::from_path(&path, Jig { slew, ..JIG })
        .expect_err("the servo is as fast as the slew limit");
    assert_matches!(error, ServoError::AtSlewLimit { .. });
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn in_at_least_85_percent_of_rendered_videos_the_true_value_lies_within_two_standard_errors() {
    let mut rng = Rng::with_seed(10);
    let setup = Setup {
        print_scale: 1.0,
        deck_height: 40.0,
    };
    let mut estimates: [Vec<(Estimate, f64)>; 3] = Default::default();
    for frame_rate in [60.0, 120.0, 240.0] {
        for shutter in [1.0 / 100.0, 1.0 / 250.0, 1.0 / 1000.0] {
            let mut studio = Studio::random(&mut rng);
            (studio.deck_tag_height, studio.exposure_s, studio.readout_s) = (40.0, shutter, 0.015);
            let servo = random_servo(&mut rng);
            let mut video = Video::default();
            servo.record(&studio, 1.0, frame_rate, &mut rng, |seconds, frame| {
                add_frame(&mut video, seconds, frame);
            });
            let analysed_video = video.analyse(setup).expect("the video can be analysed");
            let measured = measure(&analysed_video.path);
            println!("{frame_rate} frames per second, shutter {shutter:.4} s:");
            let results = gain_rate_and_width(&measured, &servo);
            for (i, (estimate, truth)) in results.into_iter().enumerate() {
                println!("  estimate {i}: {estimate:?}, truth {truth:.4}");
                estimates[i].push((estimate, truth));
            }
        }
    }
    for (i, estimates) in estimates.iter().enumerate() {
        let [hit_fraction, mean_error] = hit_fraction_and_mean_error(estimates);
        println!("estimate {i}: within two errors {hit_fraction:.2}, mean error {mean_error:.4}");
        assert!(hit_fraction > 0.85, "estimate {i}: {hit_fraction}");
    }
}
