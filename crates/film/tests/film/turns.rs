//! How well films of a servo whose truth is known are measured.

use fastrand::Rng;
use lizard_contact::Place;
use lizard_film::{Figure, Jig, Seen, Turns, TurnsTrouble};

use crate::render::normal;
use crate::servo::Servo;

/// The jig of the steps counter-clockwise.
pub const JIG: Jig = Jig {
    way: 1.0,
    slew: 1000.0,
    spin_up: 0.02,
};

/// The path of a card as tags tell it, without drawing them: each angle is off by some tenths of a degree, the mean of
/// those while the shutter is open.
fn path(servo: &Servo, rate: f64, shutter: f64, noise: f64, rng: &mut Rng) -> Vec<Seen> {
    let turning = servo.turns(1.0);
    let seen = |i: usize| {
        let seconds = i as f64 / rate + 0.3;
        let open = [-0.4, -0.2, 0.0, 0.2, 0.4].map(|part| turning.at(seconds + part * shutter));
        let angle = open.iter().sum::<f64>() / 5.0 + noise * normal(rng);
        Seen {
            seconds,
            place: Place {
                forward: 0.0,
                left: 0.0,
                heading: angle.to_radians(),
            },
        }
    };
    (0..((servo.end() - 0.3) * rate) as usize).map(seen).collect()
}

/// A random servo.
fn any(rng: &mut Rng) -> Servo {
    let mut between = |low: f64, high: f64| low + (high - low) * rng.f64();
    Servo {
        gain: between(0.9, 1.1),
        rate: between(350.0, 700.0),
        spin_up: between(0.012, 0.03),
        dead_band: between(0.3, 1.6),
        begin: between(0.3, 1.5),
        neutral: between(-180.0, 180.0),
        ..Servo::default()
    }
}

/// Distance from the truth in standard errors.
fn off(figure: Figure, truth: f64) -> f64 {
    (figure.value - truth) / figure.error
}

#[test]
fn the_truth_lies_within_two_errors_at_any_frame_rate() {
    let mut rng = Rng::with_seed(1);
    for rate in [60.0, 120.0, 240.0] {
        let mut offs: [Vec<f64>; 4] = Default::default();
        let mut errs: [Vec<f64>; 4] = Default::default();
        for _ in 0..100 {
            let servo = any(&mut rng);
            let path = path(&servo, rate, 1.0 / 120.0, 0.15, &mut rng);
            let turns = Turns::of(&path, JIG).expect("it is measured");
            let width = turns.dead_band.width.expect("a dead band");
            offs[0].push(off(turns.gain, servo.gain));
            offs[1].push(off(turns.rate, servo.rate * 0.98));
            offs[2].push(off(width, width.value.clamp(servo.dead_band, servo.dead_band+0.12)));
            errs[0].push(turns.gain.error);
            errs[1].push(turns.rate.error / servo.rate);
            errs[2].push(width.error);
            if rate == 240.0 { println!("w {:.2} found {:.3} {:.3} still {:.2} hyst {:.3} {:.3} gain {:+.4} {:.4}", servo.dead_band, width.value, width.error, turns.dead_band.still, turns.hysteresis.value, turns.hysteresis.error, turns.gain.value - servo.gain, turns.gain.error);}
            if let Some(s) = turns.spin_up { offs[3].push(off(s, servo.spin_up)); errs[3].push(s.error); }
        }
        for (offs, errs) in offs.iter().zip(&errs) {
            let within = offs.iter().filter(|off| off.abs() < 2.0).count();
            println!("{rate} {within}/{} mean {:.2} err {:.4}", offs.len(), offs.iter().sum::<f64>() / offs.len() as f64, errs.iter().sum::<f64>() / errs.len() as f64);
        }
    }
}
