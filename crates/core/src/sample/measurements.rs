//! Robots in millimetres, degrees and microseconds, the units of robot.toml.

use lizard_kinematics as kinematics;
use lizard_kinematics::{Leg, Links, Lizard};
use proptest::prelude::*;

use super::STEPS_PER_DEGREE;
use crate::numbers::calibration::Calibration;
use crate::numbers::units::{PulseWidth, Sweep};

/// A servo with its values in robot.toml.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    /// The servo's angle in the chassis frame at the neutral pulse width, deg.
    pub neutral_deg: f64,
    /// The neutral pulse width.
    pub neutral_us: f64,
    /// The change of the pulse width per degree; negative for a reversed servo.
    pub us_per_degree: f64,
    /// The shortest pulse of the servo's travel.
    pub min_us: f64,
    /// The longest pulse of the servo's travel.
    pub max_us: f64,
}

/// A robot's values in robot.toml.
#[derive(Clone, Copy, Debug)]
pub struct Measurements {
    pub lizard: Lizard,
    pub limits: kinematics::Limits,
    pub servos: [Servo; 4],
    /// The slew limit of point-to-point moves.
    pub slew_deg_per_s: f64,
}

impl Measurements {
    /// Returns the paper's robot, with the limits and servos of robots/paper.toml.
    pub fn paper() -> Self {
        let servo = |neutral_deg| Servo {
            neutral_deg,
            neutral_us: 1500.0,
            us_per_degree: 10.0,
            min_us: 600.0,
            max_us: 2400.0,
        };
        let end = [20.0, 30.0, 50.0, 50.0, 30.0];
        let side = [135.0, 30.0, 45.0, 45.0, 30.0];
        Self {
            lizard: build_lizard(end, end, side, side),
            limits: kinematics::Limits {
                type2: 0.3,
                type1: 0.3,
                leg: 0.3,
                stroke_min: -15.0,
                stroke_max: 45.0,
            },
            servos: [138.590378, 41.409622, 318.590378, 221.409622].map(servo),
            slew_deg_per_s: 300.0,
        }
    }

    /// Returns a robot without symmetry: the head differs from the tail, the left side from the right side, and no two
    /// servos are equal.
    pub fn asymmetric() -> Self {
        let servo =
            |neutral_deg, neutral_us, us_per_degree: f64, lower_deg: f64, upper_deg: f64| Servo {
                neutral_deg,
                neutral_us,
                us_per_degree,
                min_us: neutral_us - us_per_degree.abs() * lower_deg,
                max_us: neutral_us + us_per_degree.abs() * upper_deg,
            };
        Self {
            lizard: build_lizard(
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
            slew_deg_per_s: 60.0,
        }
    }

    /// Yields random robots without symmetry.
    pub fn random() -> impl Strategy<Value = Self> {
        let any_end = || [15.0..40.0, 22.0..45.0, 45.0..75.0, 45.0..75.0, 22.0..45.0];
        let any_side = || [20.0..42.0, 35.0..55.0, 35.0..55.0, 20.0..42.0];
        let limits = (
            0.12..0.4,
            0.0..0.35,
            0.0..0.35,
            -40.0..-5.0,
            5.0..60.0,
            20.0..600.0,
        );
        let any_servo = |neutral_deg: f64| {
            let numbers = (
                -15.0..15.0f64,
                1300.0..1700.0f64,
                6.0..22.0f64,
                any::<bool>(),
                40.0..110.0f64,
                40.0..110.0f64,
            );
            numbers.prop_map(move |numbers| {
                let (offset_deg, neutral_us, gain, is_reversed, lower_deg, upper_deg) = numbers;
                Servo {
                    neutral_deg: neutral_deg + offset_deg,
                    neutral_us,
                    us_per_degree: if is_reversed { -gain } else { gain },
                    min_us: (neutral_us - gain * lower_deg).max(500.0),
                    max_us: (neutral_us + gain * upper_deg).min(2500.0),
                }
            })
        };
        let strategies = (
            any_end(),
            any_end(),
            90.0..200.0,
            any_side(),
            any_side(),
            limits,
            [130.0, 50.0, 310.0, 230.0].map(any_servo),
        );
        strategies.prop_map(|(head, tail, base, left, right, limits, servos)| {
            let side_links = |links: [f64; 4]| [base, links[0], links[1], links[2], links[3]];
            let (type2, type1, leg, stroke_min, stroke_max, slew_deg_per_s) = limits;
            Self {
                lizard: build_lizard(head, tail, side_links(left), side_links(right)),
                limits: kinematics::Limits {
                    type2,
                    type1,
                    leg,
                    stroke_min,
                    stroke_max,
                },
                servos,
                slew_deg_per_s,
            }
        })
    }
}

impl Servo {
    /// Converts the servo to a calibration in the core's units, with its travel rounded inwards.
    pub fn calibration(&self) -> Calibration {
        let sweep_at = |us: f64| (us - self.neutral_us) / self.us_per_degree * STEPS_PER_DEGREE;
        let limits = [sweep_at(self.min_us), sweep_at(self.max_us)];
        Calibration {
            neutral_width: PulseWidth((self.neutral_us * 16.0).round() as u16),
            gain: (self.us_per_degree * 16.0 / STEPS_PER_DEGREE * 16384.0).round() as i16,
            travel_min: Sweep(limits[0].min(limits[1]).ceil() as i16),
            travel_max: Sweep(limits[0].max(limits[1]).floor() as i16),
        }
    }
}

/// Builds a robot from the links, in mm, of its head and tail (base, left crank, left coupler, right coupler, right
/// crank) and of its sides (chassis, rear arm, rear half of the slider, front half, front arm).
fn build_lizard(head: [f64; 5], tail: [f64; 5], left: [f64; 5], right: [f64; 5]) -> Lizard {
    let parts = [head, tail, left, right];
    let links: [f64; 20] = core::array::from_fn(|index| parts[index / 5][index % 5]);
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
