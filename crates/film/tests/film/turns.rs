//! The accuracy of measurements in films of a servo whose true values are known.

use fastrand::Rng;
use lizard_contact::Place;
use lizard_film::{Figure, Film, Jig, PathPoint, Setup, Turns, TurnsTrouble};
use lizard_studio::render::{Studio, normal};
use lizard_studio::servo::{FRICTION, FULL, Servo};

/// The jig for steps in the counter-clockwise direction.
const JIG: Jig = Jig {
    way: 1.0,
    slew: 1000.0,
    spin_up: 0.02,
};
/// The load's torque as a share of the stall torque: 19.6 N mm of 176.5.
const LOAD: f64 = 0.111;

/// A camera that makes no pictures but adds errors to angles: pictures per second, exposure time in s, and standard
/// deviation of an angle in deg.
#[derive(Clone, Copy)]
struct AngleCamera {
    rate: f64,
    shutter: f64,
    noise: f64,
}

impl AngleCamera {
    /// A phone in daylight.
    fn of_rate(rate: f64) -> Self {
        Self {
            rate,
            shutter: 1.0 / 120.0,
            noise: 0.15,
        }
    }

    /// The path of a card as its tag would show it: each angle is the mean over the time that the shutter is open.
    fn path(self, servo: &Servo, rng: &mut Rng) -> Vec<PathPoint> {
        const BEGIN: f64 = 0.3;
        let turning = servo.turns(1.0);
        let picture_at = |i: usize| {
            let seconds = i as f64 / self.rate + BEGIN;
            let shares = [-0.4, -0.2, 0.0, 0.2, 0.4];
            let angles = shares.map(|share| turning.at(seconds + share * self.shutter));
            let angle = angles.iter().sum::<f64>() / 5.0 + self.noise * normal(rng);
            point_at(seconds, angle)
        };
        let pictures = (servo.end() - BEGIN) * self.rate;
        (0..pictures as usize).map(picture_at).collect()
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
        rate: random_between(350.0, 700.0),
        spin_up: random_between(0.012, 0.03),
        dead_band: random_between(0.3, 1.6),
        begin: random_between(0.3, 1.5),
        neutral: random_between(-180.0, 180.0),
        ..Servo::default()
    }
}

/// Compares figures with their true values: returns the share of figures within two errors of the truth, and the
/// mean error.
fn judge(figures: &[(Figure, f64)]) -> [f64; 2] {
    let hits = figures
        .iter()
        .filter(|(figure, truth)| (figure.value - truth).abs() <= 2.0 * figure.error);
    let errors: f64 = figures.iter().map(|(figure, _)| figure.error).sum();
    let count = figures.len() as f64;
    [hits.count() as f64 / count, errors / count]
}

/// The true dead band nearest to the found one: any value from the controller's own width to that plus the gears'
/// friction is right.
fn nearest_dead_band(servo: &Servo, found_width: f64) -> f64 {
    let friction = 2.0 * FRICTION * FULL;
    found_width.clamp(servo.dead_band, servo.dead_band + friction)
}

#[test]
fn the_truth_lies_within_two_errors_at_60_to_240_pictures_a_second() {
    let mut rng = Rng::with_seed(1);
    for pictures in [60.0, 120.0, 240.0] {
        let mut figures: [Vec<(Figure, f64)>; 4] = Default::default();
        for _ in 0..60 {
            let servo = random_servo(&mut rng);
            let path = AngleCamera::of_rate(pictures).path(&servo, &mut rng);
            let turns = Turns::of(&path, JIG).expect("it is measured");
            let width = turns.dead_band.width.expect("a dead band");
            figures[0].push((turns.gain, servo.gain));
            figures[1].push((turns.rate, servo.own_rate()));
            figures[2].push((width, nearest_dead_band(&servo, width.value)));
            figures[3].extend(turns.spin_up.map(|spin_up| (spin_up, servo.spin_up)));
        }
        for (i, largest) in [0.005, 8.0, 0.2, 0.002].into_iter().enumerate() {
            let [share_within, error] = judge(&figures[i]);
            println!(
                "{pictures} pictures a second, figure {i}: {share_within:.2}, error {error:.4}"
            );
            assert!(share_within > 0.9, "{pictures} {i}: {share_within}");
            assert!(error < largest, "{pictures} {i}: {error}");
        }
        assert!(figures[3].len() > 30, "{}", figures[3].len());
    }
}

#[test]
fn a_load_on_a_drum_tells_the_torque_at_a_stall() {
    let mut rng = Rng::with_seed(2);
    let camera = AngleCamera::of_rate(120.0);
    let film_pair = |rng: &mut Rng| {
        let free = random_servo(rng);
        let loaded = Servo {
            load: LOAD,
            begin: 1.1,
            ..free.clone()
        };
        [free, loaded].map(|servo| Turns::of(&camera.path(&servo, rng), JIG).expect("measured"))
    };
    let mut stalls = Vec::new();
    for _ in 0..30 {
        let [free, loaded] = film_pair(&mut rng);
        let stall = free.stall(&loaded, 19.6).expect("a stall");
        // Friction reduces the torque at which the motor's torque-speed line ends.
        stalls.push((stall, 19.6 / LOAD * (1.0 - FRICTION)));
        assert_eq!(loaded.stall(&free, 19.6), Err(TurnsTrouble::Swapped));
    }
    let [share_within, error] = judge(&stalls);
    println!("stall: {share_within:.2}, error {error:.1} N mm");
    assert!(share_within > 0.9 && error < 25.0, "{share_within} {error}");
}

#[test]
fn a_load_that_slows_nothing_down_tells_no_torque() {
    let mut rng = Rng::with_seed(3);
    let measurements = [0, 1].map(|_| {
        let path = AngleCamera::of_rate(120.0).path(&Servo::default(), &mut rng);
        Turns::of(&path, JIG).expect("it is measured")
    });
    let trouble = measurements[0]
        .stall(&measurements[1], 19.6)
        .expect_err("no torque");
    let message = trouble.to_string();
    assert!(message.contains("take a heavier weight"), "{message}");
}

/// The reason why a path cannot be measured.
fn trouble_of(path: &[PathPoint]) -> TurnsTrouble {
    Turns::of(path, JIG).expect_err("it is not measured")
}

#[test]
fn a_servo_that_turns_the_wrong_way_has_a_negative_gain() {
    let servo = Servo {
        gain: -1.05,
        ..Servo::default()
    };
    let path = AngleCamera::of_rate(120.0).path(&servo, &mut Rng::with_seed(4));
    let gain = Turns::of(&path, JIG).expect("it is measured").gain;
    assert!((gain.value + 1.05).abs() < 2.0 * gain.error, "{gain:?}");
}

#[test]
fn steps_that_move_nothing_show_only_how_wide_the_dead_band_is_at_least() {
    let servo = Servo {
        dead_band: 4.0,
        ..Servo::default()
    };
    let path = AngleCamera::of_rate(60.0).path(&servo, &mut Rng::with_seed(5));
    let dead_band = Turns::of(&path, JIG).expect("it is measured").dead_band;
    assert_eq!(
        (dead_band.width, dead_band.largest_ignored_step),
        (None, 3.0)
    );
}

#[test]
fn a_horn_that_stands_still_or_turns_otherwise_is_named() {
    let mut rng = Rng::with_seed(6);
    let mut angle = 0.0;
    let mut path_of = |turn: &mut dyn FnMut(f64) -> f64| -> Vec<PathPoint> {
        (0..60 * 55)
            .map(|i| {
                angle += turn(f64::from(i) / 60.0);
                point_at(f64::from(i) / 60.0, angle)
            })
            .collect()
    };
    assert_eq!(trouble_of(&[]), TurnsTrouble::NotTurned { turn: 0.0 });
    let still_path = path_of(&mut |_| 0.0);
    assert_eq!(
        trouble_of(&still_path),
        TurnsTrouble::NotTurned { turn: 0.0 }
    );
    let swaying_path = path_of(&mut |seconds| seconds.sin());
    assert_eq!(trouble_of(&swaying_path), TurnsTrouble::NotTheSteps);
    let whole_path = AngleCamera::of_rate(60.0).path(&Servo::default(), &mut rng);
    let trouble = trouble_of(&whole_path[..whole_path.len() / 2]);
    assert!(
        matches!(trouble, TurnsTrouble::TooShort { .. }),
        "{trouble}"
    );
}

#[test]
fn a_film_in_slow_motion_or_with_few_pictures_is_named() {
    let mut rng = Rng::with_seed(7);
    let mut path = AngleCamera::of_rate(240.0).path(&Servo::default(), &mut rng);
    path.iter_mut().for_each(|point| point.seconds *= 4.0);
    assert_eq!(trouble_of(&path), TurnsTrouble::AnotherPace { times: 4.0 });
    let path = AngleCamera::of_rate(15.0).path(&Servo::default(), &mut rng);
    let trouble = trouble_of(&path);
    assert!(matches!(trouble, TurnsTrouble::FewPictures { rate } if (rate - 15.0).abs() < 0.1));
    assert!(
        trouble
            .to_string()
            .contains("film at 120 pictures a second or more")
    );
}

#[test]
fn orders_that_are_slower_than_the_servo_do_not_pass_for_its_rate() {
    let slew = 300.0;
    let servo = Servo {
        slew,
        ..Servo::default()
    };
    let path = AngleCamera::of_rate(120.0).path(&servo, &mut Rng::with_seed(8));
    let trouble = Turns::of(&path, Jig { slew, ..JIG }).expect_err("it follows the orders");
    assert!(matches!(trouble, TurnsTrouble::Ordered { .. }), "{trouble}");
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn rendered_films_of_horns_show_the_truth_within_two_errors() {
    let mut rng = Rng::with_seed(10);
    let setup = Setup {
        scale: 1.0,
        height: 40.0,
    };
    let mut figures: [Vec<(Figure, f64)>; 3] = Default::default();
    for rate in [60.0, 120.0, 240.0] {
        for shutter in [1.0 / 100.0, 1.0 / 250.0, 1.0 / 1000.0] {
            let mut studio = Studio::random(&mut rng);
            (studio.deck, studio.shutter, studio.readout) = (40.0, shutter, 0.015);
            let servo = random_servo(&mut rng);
            let mut film = Film::default();
            servo.pictures(&studio, 1.0, rate, &mut rng, |seconds, picture| {
                film.add(seconds, picture).expect("a picture");
            });
            let watched = film.watch(setup).expect("it is watched");
            let turns = Turns::of(&watched.path, JIG).expect("it is measured");
            let width = turns.dead_band.width.expect("a dead band");
            println!(
                "{rate} pictures a second, shutter {shutter:.4} s: gain {:?} of {:.4}, rate {:?} of {:.1}, dead band {width:?} of {:.2}",
                turns.gain,
                servo.gain,
                turns.rate,
                servo.own_rate(),
                servo.dead_band
            );
            figures[0].push((turns.gain, servo.gain));
            figures[1].push((turns.rate, servo.own_rate()));
            figures[2].push((width, nearest_dead_band(&servo, width.value)));
        }
    }
    for (i, figures) in figures.iter().enumerate() {
        let [share_within, error] = judge(figures);
        println!("figure {i}: within two errors {share_within:.2}, mean error {error:.4}");
        assert!(share_within > 0.85, "{i}: {share_within}");
    }
}
