//! The energy of a leg's lag behind its servo.
//!
//! In the contact model a single function describes the drive of a leg: the energy of its lag. This energy is zero
//! within the play; beyond the play it is the energy of the spring on that side; beyond a stop it rises more steeply
//! than any pad can push. Its kinks are exactly at the most likely lags, so they are smoothed over a width `eps`, like
//! the lengths of slides in `friction.rs`.

use crate::motor_step::{Expansion, MotorStep};

/// The energy of a lag, in the units of the contact problem: a pad's mean friction for forces, mm and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LagEnergy {
    /// Free movement of the leg to either side, rad.
    pub play: f64,
    /// Torque of a stop, slightly larger than a pad's largest torque; a much larger one would impede the minimisation.
    pub stop_torque: f64,
    /// Resistances to a negative and to a positive lag.
    pub resistances: [Resistance; 2],
    /// The servo's motor, if the servo may lag behind its pulses; lags then include the servo's.
    pub motor: Option<MotorStep>,
}

/// The resistance to a lag in one direction, beyond the play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Resistance {
    /// A rigid stop.
    Stop,
    /// A spring in a strut, and a stop at the end of the strut's slot.
    Strut(SlottedStrut),
}

/// A slotted strut with its spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SlottedStrut {
    /// Geometry of the strut.
    triangle: StrutTriangle,
    /// Tension of the spring if the leg does not lag.
    preload: f64,
    /// Rate of the spring, per mm.
    rate: f64,
    /// Lag beyond the play at which the screw reaches the slot's end, rad.
    end_lag: f64,
}

/// The triangle that determines a strut's length at a lag of its leg. Its sides are the strut, the leg's arm, and the
/// base: the line from the leg's pivot to the strut's end on the servo's arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StrutTriangle {
    /// Length of the base, mm.
    base: f64,
    /// Length of the leg's arm, mm.
    arm: f64,
    /// Angle between base and arm if the leg does not lag, rad; a lag adds to it.
    angle: f64,
    /// Sine and cosine of the magnitude of `angle`.
    sin_cos: (f64, f64),
    /// Length of the strut if the leg does not lag, mm.
    unlagged_length: f64,
}

/// Energy, torque and stiffness of a unit torque that resists a positive `x`; the energy is the ramp `max(x, 0)` with
/// its kink smoothed over `eps`.
fn smoothed_ramp(x: f64, eps: f64) -> Expansion {
    let length = (x * x + eps * eps).sqrt();
    if length == 0.0 {
        return Expansion {
            torque: 0.5,
            ..Expansion::default()
        };
    }
    // For a negative x the plain sum would be a difference of nearly equal numbers.
    let sum = match x > 0.0 {
        true => x + length,
        false => eps * eps / (length - x),
    };
    let ratio = eps / length;
    Expansion {
        energy: sum / 2.0,
        torque: sum / length / 2.0,
        stiffness: ratio * ratio / length / 2.0,
    }
}

impl StrutTriangle {
    /// Creates the triangle of a base and an arm, mm, with an angle between them, rad.
    pub fn new(base: f64, arm: f64, angle: f64) -> Self {
        let (sin, cos) = angle.abs().sin_cos();
        Self {
            base,
            arm,
            angle,
            sin_cos: (sin, cos),
            unlagged_length: (base * base + arm * arm - 2.0 * base * arm * cos).sqrt(),
        }
    }

    /// Lever arm of the strut's pull if the leg does not lag: the derivative of the strut's length with respect to the
    /// lag, mm/rad; negative if a positive lag shortens the strut.
    pub fn lever_arm(&self) -> f64 {
        let (sin, _) = self.sin_cos;
        (self.base * self.arm * sin / self.unlagged_length).copysign(self.angle)
    }

    /// Magnitude of the lag at which the strut is `extension` mm longer, rad; infinite if it cannot extend so far.
    pub fn lag_at_extension(&self, extension: f64) -> f64 {
        let Self { base, arm, .. } = self;
        let length = self.unlagged_length + extension;
        let cos = (base * base + arm * arm - length * length) / (2.0 * base * arm);
        match cos < -1.0 {
            true => f64::INFINITY,
            false => cos.acos() - self.angle.abs(),
        }
    }

    /// Extension of the strut (mm) at a lag that lengthens it, with its first and second derivatives with respect to
    /// the lag: the lever arm (mm/rad) and the lever arm's slope.
    ///
    /// The extension at a tiny lag is not computed as the difference of two lengths: the difference would lose most of
    /// its digits to rounding, which would mislead Newton's method.
    pub fn extension_and_derivatives(&self, lag: f64) -> (f64, f64, f64) {
        let (product, (sin, cos)) = (self.base * self.arm, self.sin_cos);
        let (half_sin, half_cos) = (lag / 2.0).sin_cos();
        let (lag_sin, lag_cos) = (2.0 * half_sin * half_cos, 1.0 - 2.0 * half_sin * half_sin);
        let squared_length_increase = 4.0 * product * (sin * half_cos + cos * half_sin) * half_sin;
        let length = (self.unlagged_length * self.unlagged_length + squared_length_increase).sqrt();
        let lever_arm = product * (sin * lag_cos + cos * lag_sin) / length;
        let lever_arm_slope =
            (product * (cos * lag_cos - sin * lag_sin) - lever_arm * lever_arm) / length;
        (
            squared_length_increase / (length + self.unlagged_length),
            lever_arm,
            lever_arm_slope,
        )
    }
}

impl SlottedStrut {
    /// Energy of the spring minus `kink_torque * lag`, at a lag that lengthens the strut.
    fn spring_energy(&self, lag: f64, kink_torque: f64) -> Expansion {
        let (preload, rate) = (self.preload, self.rate);
        let (extension, lever_arm, lever_arm_slope) = self.triangle.extension_and_derivatives(lag);
        let tension = preload + rate * extension;
        Expansion {
            energy: preload * extension - kink_torque * lag + rate * extension * extension / 2.0,
            torque: tension * lever_arm - kink_torque,
            // If the lever arm shrinks faster than the tension grows, the curvature is negative. Newton's method needs
            // a convex energy, so the curvature is then set to zero.
            stiffness: (rate * lever_arm * lever_arm + tension * lever_arm_slope).max(0.0),
        }
    }
}

impl Resistance {
    /// Creates the resistance of a strut with a spring and a slot; `slot_length` in mm.
    pub fn strut(triangle: StrutTriangle, preload: f64, rate: f64, slot_length: f64) -> Self {
        Self::Strut(SlottedStrut {
            triangle,
            preload,
            rate,
            end_lag: triangle.lag_at_extension(slot_length),
        })
    }

    /// Energy, torque and stiffness at a lag that exceeds the play by `excess_lag`, rad.
    fn expand(&self, excess_lag: f64, eps: f64, stop_torque: f64) -> Expansion {
        let ramp = smoothed_ramp(excess_lag, eps);
        match self {
            Self::Stop => Expansion::default().plus_scaled(stop_torque, ramp),
            Self::Strut(strut) => {
                // The preload causes the torque at the kink; the spring's further torque grows from zero.
                let kink_torque = strut.preload * strut.triangle.lever_arm().abs();
                let mut expansion = Expansion::default();
                if excess_lag > 0.0 {
                    expansion = strut.spring_energy(excess_lag, kink_torque);
                }
                expansion = expansion.plus_scaled(kink_torque, ramp);
                if strut.end_lag.is_finite() {
                    let end_ramp = smoothed_ramp(excess_lag - strut.end_lag, eps);
                    expansion = expansion.plus_scaled(stop_torque, end_ramp);
                }
                expansion
            }
        }
    }

    /// Torque of the spring at a lag that exceeds the play by `excess_lag`, rad.
    fn spring_torque(&self, excess_lag: f64) -> f64 {
        match self {
            Self::Strut(strut) if excess_lag > 0.0 => strut.spring_energy(excess_lag, 0.0).torque,
            _ => 0.0,
        }
    }

    /// Largest lag beyond the play, rad.
    fn max_excess_lag(&self) -> f64 {
        match self {
            Self::Stop => 0.0,
            Self::Strut(strut) => strut.end_lag,
        }
    }
}

impl LagEnergy {
    /// Energy, torque and stiffness at a lag (rad) of leg and servo together, with kinks smoothed over `eps` rad.
    pub fn expand(&self, lag: f64, eps: f64) -> Expansion {
        let Some(motor) = &self.motor else {
            return self.expand_leg(lag, eps);
        };
        if self.is_rigid() {
            return motor.expand(lag, eps);
        }
        // Leg and servo are in series, so both bear the same torque.
        let servo_lag = self.servo_lag(lag, eps);
        let motor = motor.expand(servo_lag, eps);
        let leg = self.expand_leg(lag - servo_lag, eps);
        Expansion {
            energy: motor.energy + leg.energy,
            torque: motor.torque,
            stiffness: motor.stiffness * leg.stiffness / (motor.stiffness + leg.stiffness),
        }
    }

    /// Computes the servo's part of a lag of leg and servo together, rad.
    pub fn servo_lag(&self, lag: f64, eps: f64) -> f64 {
        match &self.motor {
            None => 0.0,
            Some(_) if self.is_rigid() => lag,
            Some(motor) => {
                let kinks = [lag - self.play, lag + self.play];
                motor.find_balance_lag(kinks, self.stop_torque, eps, |servo_lag| {
                    let leg = self.expand_leg(lag - servo_lag, eps);
                    (leg.torque, leg.stiffness)
                })
            }
        }
    }

    /// True if the leg moves exactly with its servo.
    fn is_rigid(&self) -> bool {
        self.play == 0.0 && self.resistances == [Resistance::Stop; 2]
    }

    /// Energy, torque and stiffness at a lag (rad) of the leg behind its servo.
    fn expand_leg(&self, lag: f64, eps: f64) -> Expansion {
        let (play, stop_torque) = (self.play, self.stop_torque);
        let [lower, upper] = self.resistances;
        let upper = upper.expand(lag - play, eps, stop_torque);
        let lower = lower.expand(-lag - play, eps, stop_torque);
        Expansion {
            energy: upper.energy + lower.energy,
            torque: upper.torque - lower.torque,
            stiffness: upper.stiffness + lower.stiffness,
        }
    }

    /// Magnitude of the torque with which the spring pulls the leg back at `lag` (rad).
    pub fn spring_torque(&self, lag: f64) -> f64 {
        let [lower, upper] = self.resistances;
        upper.spring_torque(lag - self.play) + lower.spring_torque(-lag - self.play)
    }

    /// The smallest and the largest lag that the stops allow, rad.
    pub fn lag_range(&self) -> [f64; 2] {
        let [lower, upper] = self.resistances.map(|side| side.max_excess_lag());
        [-self.play - lower, self.play + upper]
    }

    /// The convex conjugate of the energy at a torque, for the dual problem: the maximum of torque times lag minus
    /// energy; infinite if the torque exceeds a stop's torque.
    #[cfg(test)]
    pub fn conjugate(&self, torque: f64) -> f64 {
        let [lower, upper] = self.resistances;
        let resistance = if torque > 0.0 { upper } else { lower };
        let torque = torque.abs();
        let gain_beyond_play = match resistance {
            Resistance::Stop if torque <= self.stop_torque => 0.0,
            // Ternary search: torque times lag minus energy has a single maximum.
            Resistance::Strut(_) if torque <= self.stop_torque => {
                let gain_at =
                    |x: f64| torque * x - resistance.expand(x, 0.0, self.stop_torque).energy;
                let (mut low, mut high) =
                    (0.0, resistance.max_excess_lag().min(std::f64::consts::PI));
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
    use crate::assert_near;

    const STOP_TORQUE: f64 = 400.0;

    /// The triangle of a 30.2 mm strut whose 22 mm arms are at `angle_deg` to it.
    fn triangle_at(angle_deg: f64) -> StrutTriangle {
        let (sin, cos) = f64::to_radians(angle_deg).sin_cos();
        let base = [22.0 * cos - 30.2, 22.0 * sin];
        let enclosed_angle = f64::to_radians(angle_deg) - f64::atan2(base[1], base[0]);
        StrutTriangle::new(f64::hypot(base[0], base[1]), 22.0, enclosed_angle)
    }

    /// The energy of a leg without a motor.
    fn lag_energy_with(play: f64, resistances: [Resistance; 2]) -> LagEnergy {
        LagEnergy {
            play,
            stop_torque: STOP_TORQUE,
            resistances,
            motor: None,
        }
    }

    /// Asserts that torque and stiffness match the difference quotients of the energy.
    fn assert_derivatives_match(lag_energy: LagEnergy) {
        for i in -40..40 {
            let lag = f64::from(i) / 200.0 + 1e-4;
            let expand_at = |lag| lag_energy.expand(lag, 1e-3);
            let step = 1e-6;
            let (lower, upper) = (expand_at(lag - step), expand_at(lag + step));
            let (torque, stiffness) = (expand_at(lag).torque, expand_at(lag).stiffness);
            let energy_slope = (upper.energy - lower.energy) / (2.0 * step);
            assert_near(energy_slope, torque, 1e-4 * (1.0 + torque.abs()));
            let torque_slope = (upper.torque - lower.torque) / (2.0 * step);
            assert_near(torque_slope, stiffness, 1e-3 * (1.0 + stiffness.abs()));
        }
    }

    #[test]
    fn torque_and_stiffness_match_the_derivatives_of_the_energy() {
        let strut = Resistance::strut(triangle_at(70.0), 8.0, 0.7, 5.0);
        let stop = Resistance::Stop;
        for play in [0.0, 0.02] {
            for resistances in [[stop; 2], [stop, strut], [strut; 2]] {
                assert_derivatives_match(lag_energy_with(play, resistances));
            }
        }
    }

    #[test]
    fn a_leg_is_free_within_its_play_and_held_beyond_it() {
        let triangle = triangle_at(70.0);
        let strut = Resistance::strut(triangle, 8.0, 0.7, 5.0);
        let lag_energy = lag_energy_with(0.1, [Resistance::Stop, strut]);
        for lag in [-0.1, -0.05, 0.0, 0.1] {
            assert_eq!(lag_energy.expand(lag, 0.0).energy, 0.0, "lag {lag}");
        }
        let (extension, lever_arm, _) = triangle.extension_and_derivatives(0.01);
        let torque = (8.0 + 0.7 * extension) * lever_arm;
        assert_near(lag_energy.expand(0.11, 0.0).torque, torque, 1e-9);
        assert_eq!(lag_energy.expand(-0.11, 0.0).torque, -STOP_TORQUE);
        let lag_range = [-0.1, 0.1 + triangle.lag_at_extension(5.0)];
        assert_eq!(lag_energy.lag_range(), lag_range);
        assert_near(lag_energy.spring_torque(0.11), torque, 1e-9);
        assert_eq!(lag_energy.spring_torque(-0.2), 0.0, "a stop does not pull");
    }

    #[test]
    fn a_strut_is_the_third_side_of_a_triangle() {
        let triangle = triangle_at(70.0);
        // The arms are parallel.
        assert_near(triangle.unlagged_length, 30.2, 1e-9);
        // The component of the arm perpendicular to the strut.
        let lever_arm = triangle.lever_arm().abs();
        assert_near(lever_arm, 22.0 * 70f64.to_radians().sin(), 1e-9);
        let end_lag = triangle.lag_at_extension(5.0);
        let (extension, ..) = triangle.extension_and_derivatives(end_lag);
        assert_near(extension, 5.0, 1e-9);
        assert_eq!(triangle.lag_at_extension(50.0), f64::INFINITY);
    }

    #[test]
    fn tiny_lags_and_ramps_far_below_their_kink_stay_precise() {
        let triangle = triangle_at(70.0);
        for lag in [1e-12, 1e-9, 1e-6] {
            // The Taylor series to second order.
            let (extension, ..) = triangle.extension_and_derivatives(lag);
            let (_, lever_arm, lever_arm_slope) = triangle.extension_and_derivatives(0.0);
            let expected_extension = lever_arm * lag + lever_arm_slope * lag * lag / 2.0;
            assert_near(extension / expected_extension, 1.0, 1e-11);
        }
        // Far below its kink the smoothed ramp is eps^2 / (4 |x|), even if this is far less than |x|.
        let ramp = smoothed_ramp(-0.5, 1e-9);
        assert_near(ramp.energy / 5e-19, 1.0, 1e-9);
        assert_near(ramp.torque / 1e-18, 1.0, 1e-9);
    }
}
