//! The accuracy of measurements in films of a servo whose true values are known.

use std::assert_matches;

use fastrand::Rng;
use lizard_contact::Place;
use lizard_film::{Figure, Film, Jig, MeasuredServo, PathPoint, ServoTrouble, Setup};
use lizard_studio::render::{Studio, random_normal};
use lizard_studio::servo::{FRICTION_SHARE, FULL_TORQUE_DEG, Servo};

/// The jig for steps in the counter-clockwise direction.
const JIG: Jig = Jig {
    side: 1.0,
    slew: 1000.0,
    spin_up: 0.02,
};
/// The load's torque as a share of the stall torque: 19.6 N mm of 176.5.
const LOAD_SHARE: f64 = 0.111;

/// A simulated camera that takes no pictures, but adds errors to angles.
#[derive(Clone, Copy)]
struct AngleCamera {
    /// Pictures per second.
    picture_rate: f64,
    /// Exposure time, s.
    exposure_seconds: f64,
    /// Standard deviation of an angle, deg.
    angle_sigma: f64,
}

impl AngleCamera {
    /// A phone in daylight at a number of pictures per second.
    fn phone(picture_rate: f64) -> Self {
        Self {
            picture_rate,
            exposure_seconds: 1.0 / 120.0,
            angle_sigma: 0.15,
        }
    }

    /// The path of a card as its tag would show it: each angle is the mean over the time that the shutter is open.
    fn path(self, servo: &Servo, rng: &mut Rng) -> Vec<PathPoint> {
        const BEGIN: f64 = 0.3;
        let horn_angles = servo.simulate(1.0);
        let picture_at = |i: usize| {
            let seconds = i as f64 / self.picture_rate + BEGIN;
            let shares = [-0.4, -0.2, 0.0, 0.2, 0.4];
            let angles =
                shares.map(|share| horn_angles.angle_at(seconds + share * self.exposure_seconds));
            let angle = angles.iter().sum::<f64>() / 5.0 + self.angle_sigma * random_normal(rng);
            point_at(seconds, angle)
        };
        let picture_count = (servo.end_s() - BEGIN) * self.picture_rate;
        (0..picture_count as usize).map(picture_at).collect()
    }
}

fn point_at(seconds: f64, angle: f64) -> PathPoint {
    PathPoint {
        seconds,
        place: Place {
            forward: 0.0,
            left: 0.0,
            heading: angle.to_radians(),
        },
    }
}

/// A random servo.
fn random_servo(rng: &mut Rng) -> Servo {
    let mut random_between = |low: f64, high: f64| low + (high - low) * rng.f64();
    Servo {
        gain: random_between(0.9, 1.1),
        no_load_rate: random_between(350.0, 700.0),
        spin_up: random_between(0.012, 0.03),
        dead_band: random_between(0.3, 1.6),
        first_order_s: random_between(0.3, 1.5),
        neutral_heading: random_between(-180.0, 180.0),
        ..Servo::default()
    }
}

/// The share of figures within two standard errors of their true values, and the mean standard error.
fn hit_share_and_mean_error(figures: &[(Figure, f64)]) -> [f64; 2] {
    let hits = figures
        .iter()
        .filter(|(figure, truth)| (figure.value - truth).abs() <= 2.0 * figure.error);
    let errors: f64 = figures.iter().map(|(figure, _)| figure.error).sum();
    let count = figures.len() as f64;
    [hits.count() as f64 / count, errors / count]
}

/// The true width of the dead band that is nearest to the measured one, deg: any value between the controller's own
/// width and that plus the effect of the gears' friction is correct.
fn nearest_dead_band(servo: &Servo, found_width: f64) -> f64 {
    let friction = 2.0 * FRICTION_SHARE * FULL_TORQUE_DEG;
    found_width.clamp(servo.dead_band, servo.dead_band + friction)
}

/// The measured gain, rate and width of the dead band, each with its true value.
fn gain_rate_and_width(measured: &MeasuredServo, servo: &Servo) -> [(Figure, f64); 3] {
    let width = measured.dead_band.width.expect("the dead band is measured");
    [
        (measured.gain, servo.gain),
        (measured.rate, servo.steady_rate()),
        (width, nearest_dead_band(servo, width.value)),
    ]
}

#[test]
fn over_90_percent_of_figures_lie_within_two_standard_errors_at_60_to_240_pictures_a_second() {
    let mut rng = Rng::with_seed(1);
    for picture_rate in [60.0, 120.0, 240.0] {
        let mut figures: [Vec<(Figure, f64)>; 4] = Default::default();
        for _ in 0..60 {
            let servo = random_servo(&mut rng);
            let path = AngleCamera::phone(picture_rate).path(&servo, &mut rng);
            let measured = measure(&path);
            for (figures, figure) in figures
                .iter_mut()
                .zip(gain_rate_and_width(&measured, &servo))
            {
                figures.push(figure);
            }
            figures[3].extend(measured.spin_up.map(|spin_up| (spin_up, servo.spin_up)));
        }
        for (i, max_error) in [0.005, 8.0, 0.2, 0.002].into_iter().enumerate() {
            let [hit_share, mean_error] = hit_share_and_mean_error(&figures[i]);
            println!(
                "{picture_rate} pictures a second, figure {i}: {hit_share:.2}, error {mean_error:.4}"
            );
            assert!(hit_share > 0.9, "{picture_rate} {i}: {hit_share}");
            assert!(mean_error < max_error, "{picture_rate} {i}: {mean_error}");
        }
        assert!(figures[3].len() > 30, "{}", figures[3].len());
    }
}

#[test]
fn a_known_load_gives_the_stall_torque_within_two_standard_errors_in_over_90_percent_of_film_pairs()
{
    let mut rng = Rng::with_seed(2);
    let camera = AngleCamera::phone(120.0);
    let film_pair = |rng: &mut Rng| {
        let free = random_servo(rng);
        let loaded = Servo {
            load: LOAD_SHARE,
            first_order_s: 1.1,
            ..free.clone()
        };
        [free, loaded].map(|servo| measure(&camera.path(&servo, rng)))
    };
    let mut stall_torques = Vec::new();
    for _ in 0..30 {
        let [free, loaded] = film_pair(&mut rng);
        let stall_torque = free
            .stall_torque(&loaded, 19.6)
            .expect("the load slows the servo");
        // The gears' friction reduces the stall torque.
        stall_torques.push((stall_torque, 19.6 / LOAD_SHARE * (1.0 - FRICTION_SHARE)));
        assert_eq!(
            loaded.stall_torque(&free, 19.6),
            Err(ServoTrouble::FilmsSwapped)
        );
    }
    let [hit_share, mean_error] = hit_share_and_mean_error(&stall_torques);
    println!("stall: {hit_share:.2}, error {mean_error:.1} N mm");
    assert!(
        hit_share > 0.9 && mean_error < 25.0,
        "{hit_share} {mean_error}"
    );
}

#[test]
fn a_load_that_does_not_slow_the_servo_gives_no_torque() {
    let mut rng = Rng::with_seed(3);
    let measurements = [0, 1].map(|_| {
        let path = AngleCamera::phone(120.0).path(&Servo::default(), &mut rng);
        measure(&path)
    });
    let trouble = measurements[0]
        .stall_torque(&measurements[1], 19.6)
        .expect_err("the load does not slow the servo");
    let message = trouble.to_string();
    assert!(message.contains("take a heavier weight"), "{message}");
}

/// Measures a servo by the path of its card.
fn measure(path: &[PathPoint]) -> MeasuredServo {
    MeasuredServo::of(path, JIG).expect("the servo can be measured")
}

/// The reason why a path cannot be measured.
fn trouble_of(path: &[PathPoint]) -> ServoTrouble {
    MeasuredServo::of(path, JIG).expect_err("the path cannot be measured")
}

#[test]
fn a_servo_that_turns_the_wrong_way_has_a_negative_gain() {
    let servo = Servo {
        gain: -1.05,
        ..Servo::default()
    };
    let path = AngleCamera::phone(120.0).path(&servo, &mut Rng::with_seed(4));
    let gain = measure(&path).gain;
    assert!((gain.value + 1.05).abs() < 2.0 * gain.error, "{gain:?}");
}

#[test]
fn if_no_small_step_moves_the_servo_only_the_largest_ignored_step_is_known() {
    let servo = Servo {
        dead_band: 4.0,
        ..Servo::default()
    };
    let path = AngleCamera::phone(60.0).path(&servo, &mut Rng::with_seed(5));
    let dead_band = measure(&path).dead_band;
    assert_eq!(dead_band.width, None);
    assert_eq!(dead_band.largest_ignored_step, 3.0);
}

#[test]
fn a_horn_that_does_not_follow_all_steps_is_refused_with_the_reason() {
    let mut rng = Rng::with_seed(6);
    let mut angle = 0.0;
    let mut path_of = |turn: fn(f64) -> f64| -> Vec<PathPoint> {
        let times = (0..60 * 55).map(|i| f64::from(i) / 60.0);
        let turned_point_at = |seconds| {
            angle += turn(seconds);
            point_at(seconds, angle)
        };
        times.map(turned_point_at).collect()
    };
    assert_eq!(trouble_of(&[]), ServoTrouble::NoTurn { turn: 0.0 });
    let still_path = path_of(|_| 0.0);
    assert_eq!(trouble_of(&still_path), ServoTrouble::NoTurn { turn: 0.0 });
    let swaying_path = path_of(f64::sin);
    assert_eq!(trouble_of(&swaying_path), ServoTrouble::StepMismatch);
    let complete_path = AngleCamera::phone(60.0).path(&Servo::default(), &mut rng);
    let trouble = trouble_of(&complete_path[..complete_path.len() / 2]);
    assert_matches!(trouble, ServoTrouble::TooShort { .. });
}

#[test]
fn a_film_in_slow_motion_or_with_few_pictures_is_refused_with_the_reason() {
    let mut rng = Rng::with_seed(7);
    let mut path = AngleCamera::phone(240.0).path(&Servo::default(), &mut rng);
    path.iter_mut().for_each(|point| point.seconds *= 4.0);
    let trouble = trouble_of(&path);
    assert_eq!(trouble, ServoTrouble::WrongStepInterval { ratio: 4.0 });
    let path = AngleCamera::phone(15.0).path(&Servo::default(), &mut rng);
    let trouble = trouble_of(&path);
    assert_matches!(trouble, ServoTrouble::TooFewPictures { rate } if (rate - 15.0).abs() < 0.1);
    let message = trouble.to_string();
    assert!(message.contains("film at 120 pictures a second or more"));
}

#[test]
fn a_slew_limit_below_the_rate_of_the_servo_is_not_taken_for_its_rate() {
    let slew = 300.0;
    let servo = Servo {
        slew_rate: slew,
        ..Servo::default()
    };
    let path = AngleCamera::phone(120.0).path(&servo, &mut Rng::with_seed(8));
    let trouble = MeasuredServo::of(&path, Jig { slew, ..JIG })
        .expect_err("the servo is as fast as the slew limit");
    assert_matches!(trouble, ServoTrouble::AtSlewLimit { .. });
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn in_at_least_85_percent_of_rendered_films_the_true_value_lies_within_two_standard_errors() {
    let mut rng = Rng::with_seed(10);
    let setup = Setup {
        print_scale: 1.0,
        deck_height: 40.0,
    };
    let mut figures: [Vec<(Figure, f64)>; 3] = Default::default();
    for rate in [60.0, 120.0, 240.0] {
        for shutter in [1.0 / 100.0, 1.0 / 250.0, 1.0 / 1000.0] {
            let mut studio = Studio::random(&mut rng);
            (studio.deck_tag_height, studio.exposure_s, studio.readout_s) = (40.0, shutter, 0.015);
            let servo = random_servo(&mut rng);
            let mut film = Film::default();
            servo.take_pictures(&studio, 1.0, rate, &mut rng, |seconds, picture| {
                film.add(seconds, picture)
                    .expect("the picture fits the film");
            });
            let analysed_film = film.analyse(setup).expect("the film can be analysed");
            let measured = measure(&analysed_film.path);
            let [gain, rate_figure, width] = gain_rate_and_width(&measured, &servo);
            println!(
                "{rate} pictures a second, shutter {shutter:.4} s: gain {:?} of {:.4}, rate {:?} of {:.1}, dead band {:?} of {:.2}",
                gain.0, gain.1, rate_figure.0, rate_figure.1, width.0, servo.dead_band
            );
            for (figures, figure) in figures.iter_mut().zip([gain, rate_figure, width]) {
                figures.push(figure);
            }
        }
    }
    for (i, figures) in figures.iter().enumerate() {
        let [hit_share, mean_error] = hit_share_and_mean_error(figures);
        println!("figure {i}: within two errors {hit_share:.2}, mean error {mean_error:.4}");
        assert!(hit_share > 0.85, "{i}: {hit_share}");
    }
}
