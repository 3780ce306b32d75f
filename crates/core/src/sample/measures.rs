//! Robots in millimetres and degrees, as builders measure them.

use lizard_kinematics as kinematics;
use lizard_kinematics::{Leg, Links, Lizard};
use proptest::prelude::*;

use super::STEPS_PER_DEGREE;
use crate::numbers::calibration::Calibration;
use crate::numbers::units::{Sweep, Width};

/// One servo, with the values of robot.toml.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    /// Servo angle in the chassis frame at the neutral pulse width, deg.
    pub neutral: f64,
    pub neutral_us: f64,
    /// Negative for a reversed servo.
    pub us_per_degree: f64,
    pub min_us: f64,
    pub max_us: f64,
}

/// A robot as a builder measures it.
#[derive(Clone, Copy, Debug)]
pub struct Measures {
    pub lizard: Lizard,
    pub limits: kinematics::Limits,
    pub servos: [Servo; 4],
    /// The slew limit of point-to-point moves, deg/s.
    pub slew: f64,
}

impl Measures {
    /// The paper's robot, with the limits and servos of robots/paper.toml.
    pub fn paper() -> Self {
        let servo = |neutral| Servo {
            neutral,
            neutral_us: 1500.0,
            us_per_degree: 10.0,
            min_us: 600.0,
            max_us: 2400.0,
        };
        let end = [20.0, 30.0, 50.0, 50.0, 30.0];
        let side = [135.0, 30.0, 45.0, 45.0, 30.0];
        Self {
            lizard: lizard(end, end, side, side),
            limits: kinematics::Limits {
                type2: 0.3,
                type1: 0.3,
                leg: 0.3,
                stroke_min: -15.0,
                stroke_max: 45.0,
            },
            servos: [138.590378, 41.409622, 318.590378, 221.409622].map(servo),
            slew: 300.0,
        }
    }

    /// A robot without symmetry: its head and tail, its sides and its servos all differ.
    pub fn odd() -> Self {
        let servo = |neutral, neutral_us, us_per_degree: f64, back_deg: f64, on_deg: f64| Servo {
            neutral,
            neutral_us,
            us_per_degree,
            min_us: neutral_us - us_per_degree.abs() * back_deg,
            max_us: neutral_us + us_per_degree.abs() * on_deg,
        };
        Self {
            lizard: lizard(
                [26.0, 31.0, 52.0, 57.0, 34.0],
                [33.0, 37.0, 66.0, 61.0, 29.0],
                [141.0, 33.0, 43.0, 48.0, 28.0],
                [141.0, 25.0, 47.0, 51.0, 36.0],
            ),
            limits: kinematics::Limits {
                type2: 0.34,
                type1: 0.22,
                leg: 0.13,
                stroke_min: -21.0,
                stroke_max: 38.0,
            },
            servos: [
                servo(132.37, 1510.0, 10.5, 71.0, 83.0),
                servo(47.91, 1465.0, -9.3, 88.0, 66.0),
                servo(309.64, 1533.0, 11.7, 74.0, 69.0),
                servo(226.18, 1492.0, -8.6, 81.0, 92.0),
            ],
            slew: 60.0,
        }
    }

    /// Random robots without symmetry.
    pub fn random() -> impl Strategy<Value = Self> {
        let any_end = || (15.0..40.0, 22.0..45.0, 45.0..75.0, 45.0..75.0, 22.0..45.0);
        let any_side = || (20.0..42.0, 35.0..55.0, 35.0..55.0, 20.0..42.0);
        let limits = (
            0.12..0.4,
            0.0..0.35,
            0.0..0.35,
            -40.0..-5.0,
            5.0..60.0,
            20.0..600.0,
        );
        let any_servo = || {
            (
                -15.0..15.0f64,
                1300.0..1700.0f64,
                6.0..22.0f64,
                any::<bool>(),
                40.0..110.0f64,
                40.0..110.0f64,
            )
        };
        let servos = [any_servo(), any_servo(), any_servo(), any_servo()];
        let strategies = (
            any_end(),
            any_end(),
            90.0..200.0,
            any_side(),
            any_side(),
            limits,
            servos,
        );
        strategies.prop_map(|(head, tail, base, left, right, limits, servos)| {
            let neutral = [130.0, 50.0, 310.0, 230.0];
            let servos = core::array::from_fn(|n| {
                let (offset_deg, neutral_us, gain, is_reversed, back_deg, on_deg) = servos[n];
                Servo {
                    neutral: neutral[n] + offset_deg,
                    neutral_us,
                    us_per_degree: if is_reversed { -gain } else { gain },
                    min_us: (neutral_us - gain * back_deg).max(500.0),
                    max_us: (neutral_us + gain * on_deg).min(2500.0),
                }
            });
            let links_of_end = |(l0, l1, l2, l3, l4)| [l0, l1, l2, l3, l4];
            let links_of_side = |(l11, l12, l13, l14)| [base, l11, l12, l13, l14];
            let (type2, type1, leg, stroke_min, stroke_max, slew) = limits;
            Self {
                lizard: lizard(
                    links_of_end(head),
                    links_of_end(tail),
                    links_of_side(left),
                    links_of_side(right),
                ),
                limits: kinematics::Limits {
                    type2,
                    type1,
                    leg,
                    stroke_min,
                    stroke_max,
                },
                servos,
                slew,
            }
        })
    }
}

impl Servo {
    pub fn calibration(&self) -> Calibration {
        let sweep_at = |us: f64| (us - self.neutral_us) / self.us_per_degree * STEPS_PER_DEGREE;
        let limits = [sweep_at(self.min_us), sweep_at(self.max_us)];
        Calibration {
            neutral: Width((self.neutral_us * 16.0).round() as u16),
            gain: (self.us_per_degree * 16.0 / STEPS_PER_DEGREE * 16384.0).round() as i16,
            min: Sweep(limits[0].min(limits[1]).ceil() as i16),
            max: Sweep(limits[0].max(limits[1]).floor() as i16),
        }
    }
}

/// Builds a robot from the links of head and tail (base, left crank, left and right coupler, right crank) and of
/// both sides (chassis, rear arm, rear and front half of the slider, front arm).
fn lizard(head: [f64; 5], tail: [f64; 5], left: [f64; 5], right: [f64; 5]) -> Lizard {
    let mut links = [0.0; 20];
    for (index, bars) in [head, tail, left, right].iter().enumerate() {
        links[5 * index..][..5].copy_from_slice(bars);
    }
    Lizard {
        links: Links::from(links),
        leg: Leg {
            ground: 50.0,
            crank: 45.0,
            coupler: 50.0,
            follower: 45.0,
        },
    }
}
