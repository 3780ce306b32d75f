//! A gait that has passed every check.

use std::sync::Arc;

use lizard_contact::{GroundContact, Motors, Prediction, Travel, Walker};
use lizard_core::numbers::gaits::Gait as TableGait;
use lizard_core::numbers::units::phase16;
use lizard_kinematics::Pose;

use crate::checks::accuracy::{self, TableError};
use crate::checks::audit::{self, Audit};
use crate::config::RobotConfig;
use crate::config::servo::FORWARD_TURN_SIGN;
use crate::file::ReadResult;
use crate::gaits::{Bars, Gait, Stride, to_command};
use crate::tables::Tables;
use crate::units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE};

/// A gait of robot.toml, all of whose samples have been checked, in floating point and in the firmware's tables.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedGait {
    /// The gait's definition in floating point.
    gait: Gait,
    /// Index of the gait in robot.toml and in the tables.
    index: usize,
    tables: Arc<Tables>,
    audit: Audit,
}

impl CheckedGait {
    /// Checks a gait against its robot's configuration and with the firmware's own guard.
    pub(crate) fn new(
        gait: Gait,
        index: usize,
        tables: &Arc<Tables>,
        config: &RobotConfig,
        core_robot: &lizard_core::numbers::robot::Robot,
    ) -> ReadResult<Self> {
        let audit = audit::check_gait(&gait, index, tables, config, core_robot)?;
        Ok(Self {
            gait,
            index,
            tables: Arc::clone(tables),
            audit,
        })
    }

    /// The gait in the firmware's tables.
    pub(crate) fn table_gait(&self) -> &TableGait {
        &self.tables.gaits[self.index]
    }

    /// The gait's name in robot.toml.
    pub fn name(&self) -> &str {
        &self.gait.name
    }

    /// The console command that starts the gait.
    pub fn command(&self) -> String {
        to_command(&self.gait.name)
    }

    /// Index of the gait in the file.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Duration of one cycle at full speed, s.
    pub fn period(&self) -> f64 {
        self.gait.period
    }

    /// True if the phase runs backwards, from 1 to 0.
    pub fn is_reversed(&self) -> bool {
        self.gait.is_reversed
    }

    /// True if any servo moves in a cycle.
    pub fn has_movement(&self) -> bool {
        self.table_gait().channels.iter().any(|channel| {
            let wave = &self.tables.waves[usize::from(channel.wave)];
            channel.gain != 0 && wave.iter().any(|sample| *sample != wave[0])
        })
    }

    /// The movement of each leg, in servo order: LF, RF, RH, LH.
    pub fn strides(&self) -> &[Stride; 4] {
        &self.gait.strides
    }

    /// The gait in the bar editor's form: one waveform shared by all legs. `None` if the gait does not move, or if a
    /// leg stands still or follows a path.
    pub fn bars(&self) -> Option<Bars> {
        self.has_movement()
            .then(|| Bars::from_gait(&self.gait))
            .flatten()
    }

    /// The phase (0 to 1) at a time in seconds after a start at phase 0, at full speed.
    pub fn phase_at(&self, seconds: f64) -> f64 {
        self.gait.phase_at(seconds)
    }

    /// The legs' sweeps from neutral at a phase of 0 to 1, deg, positive if the foot is forward, servo order.
    pub fn sweeps(&self, phase: f64) -> [f64; 4] {
        self.gait.sweeps(phase)
    }

    /// The servo angles at a phase of 0 to 1, deg, chassis frame, servo order.
    pub fn angles(&self, phase: f64) -> [f64; 4] {
        self.gait.angles(phase)
    }

    /// The pose at a phase of 0 to 1.
    pub fn pose(&self, phase: f64) -> Pose {
        self.angles(phase).into()
    }

    /// The servos' sweeps from the firmware's tables, at a phase in 1/65536 cycle: in 1/65536 turn from neutral,
    /// counter-clockwise positive, servo order.
    pub fn table_sweeps(&self, phase: u16) -> [i16; 4] {
        self.tables.sweeps(self.index, phase)
    }

    /// The servo angles from the firmware's tables, at a phase in 1/65536 cycle: deg, chassis frame, servo order.
    pub fn table_angles(&self, phase: u16) -> [f64; 4] {
        self.gait.angles_from_table(self.table_sweeps(phase))
    }

    /// The frames of one cycle at full speed, starting at phase 0: each frame's time in s and its phase in 1/65536
    /// cycle. The last frame is at or just after the end of the cycle.
    pub fn frames(&self) -> impl Iterator<Item = (f64, u16)> + use<> {
        let increment = self.table_gait().increment;
        // 1.1 s are 55 frames, although 1.1 * 50.0 is slightly more in floating point.
        const ROUNDING_TOLERANCE: f64 = 1e-9;
        let frame_count = (self.gait.period * FRAMES_PER_SECOND - ROUNDING_TOLERANCE).ceil() as i32;
        (0..=frame_count).map(move |frame| {
            let phase = phase16((increment * frame) as u32);
            (f64::from(frame) / FRAMES_PER_SECOND, phase)
        })
    }

    /// The extreme margins, slider travels and speeds among all checked samples.
    pub fn audit(&self) -> &Audit {
        &self.audit
    }

    /// Computes the error of the tables over all phases.
    pub fn table_error(&self) -> TableError {
        self.table_error_over(accuracy::PHASE_COUNT)
    }

    /// Computes the error of the tables over `count` evenly spaced phases.
    pub(crate) fn table_error_over(&self, count: usize) -> TableError {
        accuracy::compute_table_error(&self.gait, self.index, &self.tables, count)
    }

    /// Predicts the displacement over one cycle from phase 0, according to the contact model. If the legs lag, the
    /// result is the second cycle, which all later cycles repeat.
    ///
    /// A component is unknown if it depends on a tie, in which two feet pull against the other two with equal force.
    /// Ties are detected with rigid legs, because they depend only on the pads.
    pub fn predict(&self, ground: &GroundContact) -> Prediction {
        let prediction = ground
            .with_rigid_drive()
            .predict(self.sweeps_over_cycle(TIE_STEPS_PER_CYCLE));
        prediction.keep_determined(self.simulate_cycle(ground).travel)
    }

    /// Simulates one cycle on this ground, even if the result depends on ties. If the legs lag, the result is the
    /// second cycle.
    pub fn simulate_cycle(&self, ground: &GroundContact) -> SimulatedCycle {
        let mut walker = Walker::new(*ground, self.sweeps(self.phase_at(0.0)));
        let mut step_count = RIGID_STEPS_PER_CYCLE;
        if ground.drive.can_lag() {
            step_count = LAGGING_STEPS_PER_CYCLE;
            self.sweeps_over_cycle(step_count).for_each(|sweeps| {
                walker.move_to(sweeps);
            });
        }
        let start_pose = walker.body_pose();
        let mut max_lag = 0.0;
        for sweeps in self.sweeps_over_cycle(step_count) {
            walker.move_to(sweeps);
            let lags = walker.lags().map(f64::abs);
            max_lag = lags.into_iter().fold(max_lag, f64::max);
        }
        SimulatedCycle {
            travel: walker.body_pose().travel_from(start_pose),
            max_lag,
        }
    }

    /// Simulates two cycles on this ground with these motors, in frames as in the firmware. Returns the displacement of
    /// the second cycle. `pace` is relative to the gait's nominal pace.
    pub fn simulate_driven_cycle(
        &self,
        ground: &GroundContact,
        motors: &Motors,
        pace: f64,
    ) -> Travel {
        self.simulate_with_angle_scale(ground, motors, pace, 1.0)
    }

    /// Simulates as [`CheckedGait::simulate_driven_cycle`] does, with servos that turn `angle_scale` times as far as
    /// the firmware assumes.
    pub(crate) fn simulate_with_angle_scale(
        &self,
        ground: &GroundContact,
        motors: &Motors,
        pace: f64,
        angle_scale: f64,
    ) -> Travel {
        let (frame_count, frame_seconds) = self.simulated_frames(pace);
        let sweeps_at = |frame: usize| -> [f64; 4] {
            let seconds = frame as f64 * frame_seconds * pace;
            let phase = (self.phase_at(seconds) * 65536.0).round() as i64;
            let table_sweeps = self.table_sweeps(phase.rem_euclid(65536) as u16);
            std::array::from_fn(|i| {
                angle_scale * FORWARD_TURN_SIGN[i] * f64::from(table_sweeps[i]) / STEPS_PER_DEGREE
            })
        };
        let mut walker = Walker::new(*ground, sweeps_at(0));
        let mut walk_cycle = || {
            let start_pose = walker.body_pose();
            for frame in 1..=frame_count {
                walker.run_motors(sweeps_at(frame).map(Some), frame_seconds, motors);
            }
            walker.body_pose().travel_from(start_pose)
        };
        walk_cycle();
        walk_cycle()
    }

    /// The number of frames in a simulated cycle, and the duration of one, s. The duration differs slightly from 20 ms
    /// if the cycle is not a whole number of the firmware's frames.
    fn simulated_frames(&self, pace: f64) -> (usize, f64) {
        let cycle_seconds = self.period() / pace;
        let count = (cycle_seconds * FRAMES_PER_SECOND).round().max(1.0);
        (count as usize, cycle_seconds / count)
    }

    /// The legs' sweeps, deg, at the start of one cycle and after each of `step_count` equal steps of time.
    fn sweeps_over_cycle(&self, step_count: usize) -> impl Iterator<Item = [f64; 4]> {
        (0..=step_count)
            .map(move |i| self.sweeps(self.phase_at(self.period() * i as f64 / step_count as f64)))
    }
}

/// Steps in a cycle with rigid legs. Doubling the number changes no result by as much as 0.01 mm.
const RIGID_STEPS_PER_CYCLE: usize = 1000;
/// Steps in a cycle with legs that lag, which takes longer to compute. Quadrupling the number changes no result by as
/// much as 0.05 mm.
const LAGGING_STEPS_PER_CYCLE: usize = 250;
/// Steps in a cycle for detecting ties. Such a step takes longer to compute than a simulation step.
const TIE_STEPS_PER_CYCLE: usize = 250;

/// The result of a cycle simulated step by step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimulatedCycle {
    /// The displacement of the body over the cycle.
    pub travel: Travel,
    /// Largest lag of a leg behind its servo, deg; 0 if the legs are rigid.
    pub max_lag: f64,
}

#[cfg(test)]
mod tests {
    use crate::testing::{for_each_gait, robot};

    #[test]
    fn frames_are_20_ms_apart_and_cover_the_cycle() {
        for_each_gait(|label, _, gait| {
            let frames: Vec<(f64, u16)> = gait.frames().collect();
            assert_eq!(frames[0], (0.0, 0));
            let (end_seconds, _) = frames[frames.len() - 1];
            let overrun_seconds = end_seconds - gait.period();
            assert!((-1e-9..0.02 - 1e-9).contains(&overrun_seconds), "{label}");
            for (seconds, phase) in frames {
                // After a complete cycle, the phase is 0 again.
                let error = (f64::from(phase) / 65536.0 - gait.phase_at(seconds)).rem_euclid(1.0);
                assert!(error.min(1.0 - error) < 1e-4, "{label} at {seconds} s");
            }
        });
    }

    #[test]
    fn the_frames_of_a_simulated_cycle_last_as_long_as_the_cycle() {
        for_each_gait(|label, _, gait| {
            for pace in [1.0, 0.37] {
                let (count, seconds) = gait.simulated_frames(pace);
                let cycle_seconds = gait.period() / pace;
                let error = count as f64 * seconds - cycle_seconds;
                assert!(error.abs() < 1e-9, "{label} at pace {pace}");
                let frame_error = seconds - 0.02;
                // The differences of all frames from 20 ms add up to at most half a frame.
                assert!(frame_error.abs() <= 0.0101 / count as f64, "{label}");
            }
        });
    }

    #[test]
    fn only_the_gait_stand_has_no_movement() {
        let robot = robot("own-gaits");
        let still_gaits = robot.gaits().iter().filter(|gait| !gait.has_movement());
        let names: Vec<&str> = still_gaits.map(|gait| gait.name()).collect();
        assert_eq!(names, ["stand"]);
    }
}
