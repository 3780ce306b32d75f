//! A servo's motor in a short time step, as a convex energy: a function of the servo's lag at the end of the step. Its
//! slope is the sum of the torques of the motor, its damping, its rotor's inertia, friction and the slider. Therefore
//! the contact problem of `friction.rs` can treat a servo like a spring.

use crate::motor::Motor;

/// The state of a servo at the beginning of a step, and its target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ServoState {
    /// Commanded angle, rad.
    pub target_angle: f64,
    /// Angle of the servo, rad.
    pub angle: f64,
    /// Rate of the servo, rad/s.
    pub rate: f64,
}

/// An energy near some angle, to second order.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Expansion {
    pub energy: f64,
    /// Slope of the energy, per rad.
    pub torque: f64,
    /// Curvature of the energy, per rad^2.
    pub stiffness: f64,
}

impl Expansion {
    /// Returns the sum of this expansion and `factor` times another one.
    pub fn plus_scaled(self, factor: f64, other: Self) -> Self {
        Self {
            energy: self.energy + factor * other.energy,
            torque: self.torque + factor * other.torque,
            stiffness: self.stiffness + factor * other.stiffness,
        }
    }
}

/// The energy of a motor in a short time step, as a function of the servo's lag, rad. The lag is relative to a
/// reference: the angle that the servo would reach in the step at an unchanged rate. Torques are in the contact
/// problem's unit of force times mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotorStep {
    /// Angle by which the target leads the reference, rad.
    target_lead: f64,
    /// Error up to which the motor applies no torque, rad: half the dead band.
    half_dead_band: f64,
    /// Error beyond the dead band at which the motor applies its full torque, rad.
    full_torque_error: f64,
    /// Torque of the stalled motor.
    stall_torque: f64,
    /// Torque of the rotor's inertia and of the damping per radian of lag, for this step's duration.
    inertial_stiffness: f64,
    /// Lag at the end of the step if only inertia and damping acted, rad.
    coasting_lag: f64,
    /// Lag of a servo that stands still in this step, rad.
    standstill_lag: f64,
    /// Torque of the pins' dry friction.
    pin_torque: f64,
    /// Torque of the slider on the servo.
    slider_torque: f64,
}

impl MotorStep {
    /// Creates the energy of a step of `seconds`. The torques of the pins' friction and of the slider are in N mm; the
    /// energy uses `force_unit` newtons as its unit of force.
    pub fn new(
        motor: &Motor,
        state: ServoState,
        seconds: f64,
        [pin_torque, slider_torque]: [f64; 2],
        force_unit: f64,
    ) -> Self {
        let inertia = motor.reflected_inertia() / (seconds * seconds);
        let inertial_stiffness = inertia + motor.damping() / seconds;
        let steady_turn = state.rate * seconds;
        Self {
            target_lead: state.target_angle - state.angle - steady_turn,
            half_dead_band: motor.half_dead_band.to_radians(),
            full_torque_error: motor.full_torque_error.to_radians(),
            stall_torque: motor.stall_torque / force_unit,
            inertial_stiffness: inertial_stiffness / force_unit,
            coasting_lag: steady_turn * (1.0 - inertia / inertial_stiffness),
            standstill_lag: steady_turn,
            pin_torque: pin_torque / force_unit,
            slider_torque: slider_torque / force_unit,
        }
    }

    /// Computes energy, torque and stiffness at a lag (rad), with the kink of dry friction smoothed over `eps` rad.
    pub fn expand(&self, lag: f64, eps: f64) -> Expansion {
        let error = self.target_lead + lag;
        let excess_error = (error.abs() - self.half_dead_band).max(0.0);
        let gain = self.stall_torque / self.full_torque_error;
        let (energy, torque, stiffness) = match excess_error < self.full_torque_error {
            true if excess_error > 0.0 => (
                gain * excess_error * excess_error / 2.0,
                gain * excess_error,
                gain,
            ),
            true => (0.0, 0.0, 0.0),
            false => (
                self.stall_torque * (excess_error - self.full_torque_error / 2.0),
                self.stall_torque,
                0.0,
            ),
        };
        let coasting_deviation = lag - self.coasting_lag;
        let backward_turn = lag - self.standstill_lag;
        let smoothed_turn = (backward_turn * backward_turn + eps * eps).sqrt();
        let (direction, curvature) = match smoothed_turn > 0.0 {
            true => (
                backward_turn / smoothed_turn,
                eps * eps / (smoothed_turn * smoothed_turn * smoothed_turn),
            ),
            false => (0.0, 0.0),
        };
        Expansion {
            energy: energy
                + self.inertial_stiffness * coasting_deviation * coasting_deviation / 2.0
                + self.pin_torque * smoothed_turn
                + self.slider_torque * lag,
            torque: torque.copysign(error)
                + self.inertial_stiffness * coasting_deviation
                + self.pin_torque * direction
                + self.slider_torque,
            stiffness: stiffness + self.inertial_stiffness + self.pin_torque * curvature,
        }
    }

    /// Computes an unloaded servo's lag at the end of the step, to first order, rad.
    pub fn unloaded_lag(&self) -> f64 {
        -self.expand(0.0, 0.0).torque / self.inertial_stiffness
    }

    /// Finds the lag (rad) at which the motor's torque equals the load's. `load_at` returns the load's torque and
    /// stiffness at a lag; this torque is at most `max_load_torque` and changes abruptly at the `kinks`, in ascending
    /// order.
    pub fn find_balance_lag(
        &self,
        kinks: [f64; 2],
        max_load_torque: f64,
        eps: f64,
        load_at: impl Fn(f64) -> (f64, f64),
    ) -> f64 {
        let max_deviation =
            (self.stall_torque + self.pin_torque + self.slider_torque.abs() + max_load_torque)
                / self.inertial_stiffness;
        let mut low = self.coasting_lag - max_deviation;
        let mut high = self.coasting_lag + max_deviation;
        let guess = self.unloaded_lag().max(kinks[0]).min(kinks[1]);
        let mut lag = guess.max(low).min(high);
        let mut last_step_length = max_deviation;
        for _ in 0..MAX_ITERATIONS {
            let motor = self.expand(lag, eps);
            let (load_torque, load_stiffness) = load_at(lag);
            let torque_error = motor.torque - load_torque;
            match torque_error > 0.0 {
                true => high = lag,
                false => low = lag,
            }
            let newton_lag = lag - torque_error / (motor.stiffness + load_stiffness);
            let step_length = (newton_lag - lag).abs();
            if step_length <= f64::EPSILON * (max_deviation + lag.abs()) {
                return newton_lag;
            }
            // Newton's steps shrink unless a kink lies before the solution; then the kink or bisection gives the next
            // lag.
            let is_between = |lag: &f64| low < *lag && *lag < high;
            let next = match is_between(&newton_lag) && step_length <= last_step_length {
                true => newton_lag,
                false => {
                    let kink = kinks.into_iter().find(is_between);
                    kink.unwrap_or(f64::midpoint(low, high))
                }
            };
            last_step_length = (next - lag).abs();
            lag = next;
        }
        lag
    }
}

/// Largest number of iterations in a search for a balance: as many as bisection alone would need.
const MAX_ITERATIONS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;
    use crate::motor::SG90;

    #[test]
    fn torque_and_stiffness_match_the_derivatives_of_the_energy() {
        let state = ServoState {
            target_angle: 0.2,
            angle: 0.05,
            rate: 3.0,
        };
        let motor_step = MotorStep::new(&SG90, state, 0.0025, [12.0, -4.0], 0.7);
        for step in -40..40 {
            let lag = f64::from(step) / 200.0 + 1e-4;
            let expand_at = |lag: f64| motor_step.expand(lag, 1e-3);
            let (lower, upper) = (expand_at(lag - 1e-6), expand_at(lag + 1e-6));
            let (torque, stiffness) = (expand_at(lag).torque, expand_at(lag).stiffness);
            let energy_slope = (upper.energy - lower.energy) / 2e-6;
            assert_near(energy_slope, torque, 1e-3 * torque.abs().max(1.0));
            let torque_slope = (upper.torque - lower.torque) / 2e-6;
            assert_near(torque_slope / stiffness, 1.0, 1e-2);
        }
    }
}
