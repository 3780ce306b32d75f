//! A servo's motor in a short time step, as one convex energy of the servo's lag at the end of the step. The slope
//! of that energy is the sum of the torques of the motor, its damping, its rotor's inertia and friction. So the
//! contact problem of `friction.rs` treats a servo like a spring.

use crate::motor::Motor;

/// The motion of a servo at the beginning of a step, in rad and rad/s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ServoState {
    /// Angle that the pulse asks for.
    pub target: f64,
    /// Angle of the servo.
    pub servo: f64,
    /// Rate of the servo.
    pub rate: f64,
}

/// The value, slope and curvature of an energy.
pub(crate) type Expansion = (f64, f64, f64);

/// The energy of a motor in a short time step, as a function of the servo's lag. The lag is the
/// angle, rad, by which the servo is behind a reference: the angle that it would have at an unchanged rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotorStep {
    /// Angle of the target ahead of the reference, rad.
    target_ahead: f64,
    /// Half the dead band: the error up to which there is no torque, rad.
    idle: f64,
    /// Error beyond the dead band at which the torque is full, rad.
    full: f64,
    /// Torque at stall.
    stall: f64,
    /// Stiffness that the rotor's inertia and the damping have in a step of this length.
    inertial_stiffness: f64,
    /// Lag at the end of the step if only inertia and damping acted, rad.
    unloaded: f64,
    /// Lag of a servo that does not turn in this step, rad.
    unmoved: f64,
    /// Torque of dry friction.
    drag: f64,
    /// Torque of the slider on the servo.
    slider: f64,
}

impl MotorStep {
    /// Describes a step of `seconds`. `drag` and `slider` are the torques of dry friction and of
    /// the slider, N mm; the unit of all forces inside is `force_unit` N.
    pub fn new(
        motor: &Motor,
        state: ServoState,
        seconds: f64,
        [drag, slider]: [f64; 2],
        force_unit: f64,
    ) -> Self {
        let inertia = motor.inertia() / (seconds * seconds);
        let inertial_stiffness = inertia + motor.damping() / seconds;
        let steady_turn = state.rate * seconds;
        Self {
            target_ahead: state.target - state.servo - steady_turn,
            idle: motor.half_dead_band.to_radians(),
            full: motor.full_torque_error.to_radians(),
            stall: motor.stall / force_unit,
            inertial_stiffness: inertial_stiffness / force_unit,
            unloaded: steady_turn * (1.0 - inertia / inertial_stiffness),
            unmoved: steady_turn,
            drag: drag / force_unit,
            slider: slider / force_unit,
        }
    }

    /// Energy at a lag, its slope and its curvature, with the kink of dry friction rounded off
    /// within `eps` rad.
    pub fn expand(&self, lag: f64, eps: f64) -> Expansion {
        let error = self.target_ahead + lag;
        let excess = (error.abs() - self.idle).max(0.0);
        let gain = self.stall / self.full;
        let (energy, torque, stiffness) = match excess < self.full {
            true if excess > 0.0 => (gain * excess * excess / 2.0, gain * excess, gain),
            true => (0.0, 0.0, 0.0),
            false => (self.stall * (excess - self.full / 2.0), self.stall, 0.0),
        };
        let deviation = lag - self.unloaded;
        let turn_angle = lag - self.unmoved;
        let length = (turn_angle * turn_angle + eps * eps).sqrt();
        let (direction, curvature) = match length > 0.0 {
            true => (turn_angle / length, eps * eps / (length * length * length)),
            false => (0.0, 0.0),
        };
        (
            energy
                + self.inertial_stiffness * deviation * deviation / 2.0
                + self.drag * length
                + self.slider * lag,
            torque.copysign(error)
                + self.inertial_stiffness * deviation
                + self.drag * direction
                + self.slider,
            stiffness + self.inertial_stiffness + self.drag * curvature,
        )
    }

    /// Lag of an unloaded servo at the end of the step, to first order, rad.
    pub fn unloaded_end(&self) -> f64 {
        -self.expand(0.0, 0.0).1 / self.inertial_stiffness
    }

    /// The lag at which the motor's torque equals the load's. `load_at` returns the load's torque and
    /// stiffness at a lag; this torque is at most `max_load`, and changes fast at the `kinks`.
    pub fn balance(
        &self,
        kinks: [f64; 2],
        max_load: f64,
        eps: f64,
        load_at: impl Fn(f64) -> (f64, f64),
    ) -> f64 {
        let reach =
            (self.stall + self.drag + self.slider.abs() + max_load) / self.inertial_stiffness;
        let (mut low, mut high) = (self.unloaded - reach, self.unloaded + reach);
        let guess = self.unloaded_end().max(kinks[0]).min(kinks[1]);
        let mut lag = guess.max(low).min(high);
        let mut longest_step = reach;
        for _ in 0..MAX_ITERATIONS {
            let (_, torque, stiffness) = self.expand(lag, eps);
            let (load, load_stiffness) = load_at(lag);
            let error = torque - load;
            match error > 0.0 {
                true => high = lag,
                false => low = lag,
            }
            let newton = lag - error / (stiffness + load_stiffness);
            let step_length = (newton - lag).abs();
            if step_length <= f64::EPSILON * (reach + lag.abs()) {
                return newton;
            }
            // Newton's steps shrink, unless a kink lies in between.
            let is_between = |lag: &f64| low < *lag && *lag < high;
            let next = match is_between(&newton) && step_length <= longest_step {
                true => newton,
                false => {
                    let kink = kinks.into_iter().find(is_between);
                    kink.unwrap_or(f64::midpoint(low, high))
                }
            };
            longest_step = (next - lag).abs();
            lag = next;
        }
        lag
    }
}

/// The largest number of iterations of a balance: as many as bisection alone would need.
const MAX_ITERATIONS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_energy_of_a_step_has_its_torque_as_slope() {
        let motor = Motor {
            stall: 176.5,
            no_load_speed: 500.0,
            spin_up: 0.02,
            full_torque_error: 3.0,
            half_dead_band: 0.0,
        };
        let state = ServoState {
            target: 0.2,
            servo: 0.05,
            rate: 3.0,
        };
        let motor_step = MotorStep::new(&motor, state, 0.0025, [12.0, -4.0], 0.7);
        for step in -40..40 {
            let lag = f64::from(step) / 200.0 + 1e-4;
            let expand_at = |lag: f64| motor_step.expand(lag, 1e-3);
            let (lower, upper) = (expand_at(lag - 1e-6), expand_at(lag + 1e-6));
            let (_, torque, stiffness) = expand_at(lag);
            let measured_torque = (upper.0 - lower.0) / 2e-6;
            assert!(
                (measured_torque - torque).abs() < 1e-3 * torque.abs().max(1.0),
                "{lag}"
            );
            let measured_stiffness = (upper.1 - lower.1) / 2e-6;
            assert!(
                (measured_stiffness / stiffness - 1.0).abs() < 1e-2,
                "{lag} {measured_stiffness} {stiffness}"
            );
        }
    }
}
