//! The energy of a leg's lag behind its servo.
//!
//! In the contact model a single function describes the drive of a leg, the energy of its
//! lag: zero within the play, beyond it the energy of the spring on that side, and beyond
//! a stop a slope that no pad can climb. It has kinks at the lags that are most likely.
//! They are rounded off within `eps`, like the lengths of slides in `friction.rs`.

use crate::motor_step::{Expansion, MotorStep};

/// The energy of a lag, in the units of the contact problem: forces over the mean friction of a
/// pad, mm and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LagEnergy {
    /// Free movement of the leg to either side, rad.
    pub play: f64,
    /// Torque of a stop, larger than the largest torque of a pad. A much larger one would only make
    /// the cost harder to minimise.
    pub stop: f64,
    /// Resistance to a lag below 0.
    pub lower: Side,
    /// Resistance to a lag above 0.
    pub upper: Side,
    /// The servo's motor, if the servo may lag behind its pulses; lags are then those of leg and servo
    /// together.
    pub motor: Option<MotorStep>,
}

/// The resistance to a lag on one side, beyond the play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Side {
    /// A rigid stop.
    Stop,
    /// A spring in a strut, and a stop at the end of its slot.
    Strut {
        /// Geometry of the strut.
        stretch: Stretch,
        /// Pull of the spring without a lag.
        force: f64,
        /// Rate of the spring, per mm.
        rate: f64,
        /// Lag at the end of the slot, beyond the play, rad.
        end_lag: f64,
    },
}

/// The stretching of a strut by a leg's lag. The strut is one side of a triangle; the other two are
/// the leg's arm and the line from the leg's pivot to the strut's joint at the servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// Distance from the leg's pivot to the strut's joint at the servo, mm.
    line: f64,
    /// Length of the leg's arm, mm.
    arm: f64,
    /// Angle between line and arm while the leg does not lag, rad; a lag adds to it.
    angle: f64,
    /// Sine and cosine of the magnitude of `angle`.
    sin_cos: (f64, f64),
    /// Length of the strut while the leg does not lag, mm.
    unlagged_length: f64,
}

/// The ramp `max(x, 0)` with its kink rounded off within `eps`: value, slope and curvature.
fn rounded_ramp(x: f64, eps: f64) -> Expansion {
    let length = (x * x + eps * eps).sqrt();
    if length == 0.0 {
        return (0.0, 0.5, 0.0);
    }
    // Below 0 this sum would be a difference of nearly equal numbers.
    let sum = match x > 0.0 {
        true => x + length,
        false => eps * eps / (length - x),
    };
    let ratio = eps / length;
    (sum / 2.0, sum / length / 2.0, ratio * ratio / length / 2.0)
}

impl Stretch {
    /// Makes the triangle of a line and an arm (mm) with an angle between them, rad.
    pub fn new(line: f64, arm: f64, angle: f64) -> Self {
        let sin_cos = angle.abs().sin_cos();
        Self {
            line,
            arm,
            angle,
            sin_cos,
            unlagged_length: (line * line + arm * arm - 2.0 * line * arm * sin_cos.1).sqrt(),
        }
    }

    /// Lever of the strut's pull while the leg does not lag: the derivative of its length by the
    /// lag, mm/rad. It is negative if a lag makes the strut shorter.
    pub fn lever(&self) -> f64 {
        (self.line * self.arm * self.sin_cos.0 / self.unlagged_length).copysign(self.angle)
    }

    /// Magnitude of the lever after a lag in the direction in which the strut grows.
    pub fn lever_after(&self, lag: f64) -> f64 {
        self.growth_and_derivatives(lag).1
    }

    /// Magnitude of the lag at which the strut has grown by this length, rad; infinite if it
    /// cannot grow so far.
    pub fn lag_at_growth(&self, growth: f64) -> f64 {
        let Self { line, arm, .. } = self;
        let length = self.unlagged_length + growth;
        let cos = (line * line + arm * arm - length * length) / (2.0 * line * arm);
        match cos < -1.0 {
            true => f64::INFINITY,
            false => cos.acos() - self.angle.abs(),
        }
    }

    /// Growth of the strut's length (mm) after a lag in the direction in which it grows, with its
    /// first and second derivative by the lag: the lever (mm/rad) and its slope.
    ///
    /// Lags are often a hundred-thousandth of a radian. The difference of two lengths
    /// would then be mostly rounding, and Newton's method would look for a minimum in it.
    fn growth_and_derivatives(&self, lag: f64) -> (f64, f64, f64) {
        let (product, (sin, cos)) = (self.line * self.arm, self.sin_cos);
        let (half_sin, half_cos) = (lag / 2.0).sin_cos();
        let (lag_sin, lag_cos) = (2.0 * half_sin * half_cos, 1.0 - 2.0 * half_sin * half_sin);
        let square_growth = 4.0 * product * (sin * half_cos + cos * half_sin) * half_sin;
        let length = (self.unlagged_length * self.unlagged_length + square_growth).sqrt();
        let lever = product * (sin * lag_cos + cos * lag_sin) / length;
        let lever_slope = (product * (cos * lag_cos - sin * lag_sin) - lever * lever) / length;
        (
            square_growth / (length + self.unlagged_length),
            lever,
            lever_slope,
        )
    }

    /// Energy of a spring that pulls the strut together with `force` and `rate`, less
    /// `preload * lag`; `lag` is in the direction in which the strut grows.
    fn energy(&self, lag: f64, force: f64, rate: f64, preload: f64) -> Expansion {
        let (growth, lever, lever_slope) = self.growth_and_derivatives(lag);
        let pull = force + rate * growth;
        (
            force * growth - preload * lag + rate * growth * growth / 2.0,
            pull * lever - preload,
            // If the lever shrinks faster than the pull grows, the curvature is negative, which Newton's method
            // cannot use; it gets zero instead.
            (rate * lever * lever + pull * lever_slope).max(0.0),
        )
    }
}

impl Side {
    /// The resistance of a strut with a spring and a slot; `slot` is the slot's length, mm.
    pub fn strut(stretch: Stretch, force: f64, rate: f64, slot: f64) -> Self {
        Self::Strut {
            stretch,
            force,
            rate,
            end_lag: stretch.lag_at_growth(slot),
        }
    }

    /// Energy, torque and stiffness at a lag beyond the play.
    fn expand(&self, excess_lag: f64, eps: f64, stop: f64) -> Expansion {
        let (ramp_value, slope, curvature) = rounded_ramp(excess_lag, eps);
        let kink_of = |torque: f64| (torque * ramp_value, torque * slope, torque * curvature);
        let add = |a: Expansion, b: Expansion| (a.0 + b.0, a.1 + b.1, a.2 + b.2);
        match *self {
            Self::Stop => kink_of(stop),
            Self::Strut {
                stretch,
                force,
                rate,
                end_lag,
            } => {
                // The preload is the torque at a kink; the spring's further torque grows from zero.
                let preload = force * stretch.lever().abs();
                let spring_energy = match excess_lag > 0.0 {
                    true => stretch.energy(excess_lag, force, rate, preload),
                    false => (0.0, 0.0, 0.0),
                };
                let (value, slope, curvature) = rounded_ramp(excess_lag - end_lag, eps);
                let end_energy = match end_lag.is_finite() {
                    true => (stop * value, stop * slope, stop * curvature),
                    false => (0.0, 0.0, 0.0),
                };
                add(add(kink_of(preload), spring_energy), end_energy)
            }
        }
    }

    /// Torque of the spring at a lag beyond the play.
    fn spring_torque(&self, excess_lag: f64) -> f64 {
        match *self {
            _ if excess_lag <= 0.0 => 0.0,
            Self::Stop => 0.0,
            Self::Strut {
                stretch,
                force,
                rate,
                ..
            } => stretch.energy(excess_lag, force, rate, 0.0).1,
        }
    }

    /// Largest lag beyond the play.
    fn max_lag(&self) -> f64 {
        match self {
            Self::Stop => 0.0,
            Self::Strut { end_lag, .. } => *end_lag,
        }
    }
}

impl LagEnergy {
    /// Energy at a lag (rad) of leg and servo together, its slope and its curvature, with kinks
    /// rounded off within `eps` rad.
    pub fn expand(&self, lag: f64, eps: f64) -> Expansion {
        let Some(motor) = &self.motor else {
            return self.expand_leg(lag, eps);
        };
        if self.is_rigid() {
            return motor.expand(lag, eps);
        }
        // Leg and servo are in series: both have the same torque.
        let servo_lag = self.servo_lag(lag, eps);
        let (motor_energy, torque, motor_stiffness) = motor.expand(servo_lag, eps);
        let (leg_energy, _, leg_stiffness) = self.expand_leg(lag - servo_lag, eps);
        (
            motor_energy + leg_energy,
            torque,
            motor_stiffness * leg_stiffness / (motor_stiffness + leg_stiffness),
        )
    }

    /// Angle of the servo behind its reference at a lag of leg and servo together, rad.
    pub fn servo_lag(&self, lag: f64, eps: f64) -> f64 {
        match &self.motor {
            None => 0.0,
            Some(_) if self.is_rigid() => lag,
            Some(motor) => {
                let kinks = [lag - self.play, lag + self.play];
                motor.balance(kinks, self.stop, eps, |servo_lag| {
                    let (_, torque, stiffness) = self.expand_leg(lag - servo_lag, eps);
                    (torque, stiffness)
                })
            }
        }
    }

    /// True if the leg moves exactly with its servo.
    fn is_rigid(&self) -> bool {
        self.play == 0.0 && self.lower == Side::Stop && self.upper == Side::Stop
    }

    /// The energy of a leg's lag behind its servo.
    fn expand_leg(&self, lag: f64, eps: f64) -> Expansion {
        let (energy_up, slope_up, curvature_up) =
            self.upper.expand(lag - self.play, eps, self.stop);
        let (energy_down, slope_down, curvature_down) =
            self.lower.expand(-lag - self.play, eps, self.stop);
        (
            energy_up + energy_down,
            slope_up - slope_down,
            curvature_up + curvature_down,
        )
    }

    /// Magnitude of the torque with which the spring pulls the leg back.
    pub fn spring_torque(&self, lag: f64) -> f64 {
        self.upper.spring_torque(lag - self.play) + self.lower.spring_torque(-lag - self.play)
    }

    /// Least and greatest lag that the stops allow, rad.
    pub fn stops(&self) -> [f64; 2] {
        [
            -self.play - self.lower.max_lag(),
            self.play + self.upper.max_lag(),
        ]
    }

    /// Largest gain of a torque on this drive: the convex conjugate of the energy, for the proof
    /// by duality. It is infinite for a torque that no stop bears.
    #[cfg(test)]
    pub fn conjugate(&self, torque: f64) -> f64 {
        let side = if torque > 0.0 { self.upper } else { self.lower };
        let torque = torque.abs();
        let gain_beyond_play = match side {
            Side::Stop if torque <= self.stop => 0.0,
            // Ternary search: torque times lag minus the energy has a single maximum.
            Side::Strut { .. } if torque <= self.stop => {
                let gain_at = |x: f64| torque * x - side.expand(x, 0.0, self.stop).0;
                let (mut low, mut high) = (0.0, side.max_lag().min(std::f64::consts::PI));
                for _ in 0..200 {
                    let third = (high - low) / 3.0;
                    match gain_at(low + third) < gain_at(high - third) {
                        true => low += third,
                        false => high -= third,
                    }
                }
                gain_at((low + high) / 2.0).max(0.0)
            }
            _ => f64::INFINITY,
        };
        gain_beyond_play + torque * self.play
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOP_TORQUE: f64 = 400.0;

    /// The triangle of a strut of 30.2 mm with arms of 22 mm, at `angle_deg` deg to the strut.
    fn stretch_at(angle_deg: f64) -> Stretch {
        let (sin, cos) = f64::to_radians(angle_deg).sin_cos();
        let line = [22.0 * cos - 30.2, 22.0 * sin];
        let enclosed_angle = f64::to_radians(angle_deg) - f64::atan2(line[1], line[0]);
        Stretch::new(f64::hypot(line[0], line[1]), 22.0, enclosed_angle)
    }

    /// Compares slope and curvature of the energy with difference quotients.
    fn assert_slopes(drive: LagEnergy, lags: impl IntoIterator<Item = f64>) {
        for lag in lags {
            let (_, slope, curvature) = drive.expand(lag, 1e-3);
            let expand_at = |lag| drive.expand(lag, 1e-3);
            let step = 1e-6;
            let (lower, upper) = (expand_at(lag - step), expand_at(lag + step));
            let measured = (upper.0 - lower.0) / (2.0 * step);
            assert!(
                (measured - slope).abs() < 1e-4 * (1.0 + slope.abs()),
                "{lag} {measured} {slope}"
            );
            let measured = (upper.1 - lower.1) / (2.0 * step);
            assert!(
                (measured - curvature).abs() < 1e-3 * (1.0 + curvature.abs()),
                "{lag} {measured} {curvature}"
            );
        }
    }

    #[test]
    fn the_slope_of_the_energy_is_the_torque_and_its_slope_the_stiffness() {
        let lags = (-40..40).map(|i| f64::from(i) / 200.0 + 1e-4);
        for play in [0.0, 0.02] {
            let drive_with = |lower, upper| LagEnergy {
                play,
                stop: STOP_TORQUE,
                lower,
                upper,
                motor: None,
            };
            let side = Side::strut(stretch_at(70.0), 8.0, 0.7, 5.0);
            for sides in [[Side::Stop; 2], [Side::Stop, side], [side; 2]] {
                assert_slopes(drive_with(sides[0], sides[1]), lags.clone());
            }
        }
    }

    #[test]
    fn a_leg_is_free_within_its_play_and_no_further() {
        let strut = stretch_at(70.0);
        let drive = LagEnergy {
            play: 0.1,
            stop: STOP_TORQUE,
            lower: Side::Stop,
            upper: Side::strut(strut, 8.0, 0.7, 5.0),
            motor: None,
        };
        for lag in [-0.1, -0.05, 0.0, 0.1] {
            assert_eq!(drive.expand(lag, 0.0).0, 0.0, "{lag}");
        }
        let (growth, lever, _) = strut.growth_and_derivatives(0.01);
        let torque = (8.0 + 0.7 * growth) * lever;
        assert!((drive.expand(0.11, 0.0).1 - torque).abs() < 1e-9);
        assert_eq!(drive.expand(-0.11, 0.0).1, -STOP_TORQUE);
        assert_eq!(drive.stops(), [-0.1, 0.1 + strut.lag_at_growth(5.0)]);
        assert!((drive.spring_torque(0.11) - torque).abs() < 1e-9);
        assert_eq!(drive.spring_torque(-0.2), 0.0, "a stop does not pull");
    }

    #[test]
    fn a_strut_is_the_third_side_of_a_triangle() {
        let strut = stretch_at(70.0);
        assert!((strut.unlagged_length - 30.2).abs() < 1e-9, "parallel arms");
        // The arm's component square to the strut.
        assert!((strut.lever().abs() - 22.0 * 70f64.to_radians().sin()).abs() < 1e-9);
        let end_lag = strut.lag_at_growth(5.0);
        let (growth, ..) = strut.growth_and_derivatives(end_lag);
        assert!((growth - 5.0).abs() < 1e-9, "{growth}");
        assert_eq!(strut.lag_at_growth(50.0), f64::INFINITY);
    }

    #[test]
    fn the_energy_of_a_tiny_lag_is_exact() {
        let strut = stretch_at(70.0);
        for lag in [1e-12, 1e-9, 1e-6] {
            // A series: the lever to first order, half its slope to second order.
            let (growth, ..) = strut.growth_and_derivatives(lag);
            let (_, lever, lever_slope) = strut.growth_and_derivatives(0.0);
            let series = lever * lag + lever_slope * lag * lag / 2.0;
            assert!((growth / series - 1.0).abs() < 1e-11, "{lag} {growth}");
        }
        // Far below a kink the rounded value is eps^2 / 4 |x|, even where that is 1e16 times less
        // than x.
        let (value, slope, _) = rounded_ramp(-0.5, 1e-9);
        assert!((value / 5e-19 - 1.0).abs() < 1e-9, "{value}");
        assert!((slope / 1e-18 - 1.0).abs() < 1e-9, "{slope}");
    }
}
