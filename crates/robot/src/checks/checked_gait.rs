//! A gait that may be walked.

use lizard_contact::{Ground, Prediction, Travel, Walker};
use lizard_kinematics::Pose;

use crate::checks::audit::Audit;
use crate::gaits::Stride;
use crate::tables::{TableError, TabledGait, accuracy};

/// A gait of robot.toml whose every sample has been checked: in floating point,
/// the truth, and as the firmware's table has it.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedGait {
    gait: TabledGait,
    audit: Audit,
}

impl CheckedGait {
    /// A gait that was checked, and what the check found.
    pub(crate) fn new(gait: TabledGait, audit: Audit) -> Self {
        Self { gait, audit }
    }

    /// The gait and its table.
    #[cfg(test)]
    pub(crate) fn tabled(&self) -> &TabledGait {
        &self.gait
    }

    /// Its name; with a blank for each dash also its console command.
    pub fn name(&self) -> &str {
        self.gait.name()
    }

    /// Its place among the gaits, from 0.
    pub fn index(&self) -> usize {
        self.gait.index()
    }

    /// Time of one cycle at full speed, s.
    pub fn period(&self) -> f64 {
        self.gait.gait().period
    }

    /// True where the phase runs backwards, from 1 to 0.
    pub fn is_reversed(&self) -> bool {
        self.gait.gait().reversed
    }

    /// True if a servo moves in the course of a cycle.
    pub fn moves(&self) -> bool {
        self.gait.moves()
    }

    /// What each leg does, in servo order: LF, RF, RH, LH.
    pub fn strides(&self) -> &[Stride; 4] {
        &self.gait.gait().strides
    }

    /// The neutral servo angles, deg, chassis frame, servo order.
    pub fn neutral(&self) -> [f64; 4] {
        self.gait.gait().neutral
    }

    /// The phase, 0 to 1, at a time in s after a start at phase 0, at full speed.
    pub fn phase(&self, seconds: f64) -> f64 {
        self.gait.gait().phase(seconds)
    }

    /// The legs' sweeps from neutral at a phase of 0 to 1, deg, foot forward
    /// positive, servo order.
    pub fn sweeps(&self, phase: f64) -> [f64; 4] {
        self.gait.gait().sweeps(phase)
    }

    /// The servo angles at a phase of 0 to 1, deg, chassis frame, servo order.
    pub fn angles(&self, phase: f64) -> [f64; 4] {
        self.gait.gait().angles(phase)
    }

    /// The pose at a phase of 0 to 1.
    pub fn pose(&self, phase: f64) -> Pose {
        self.angles(phase).into()
    }

    /// The servos' sweeps at a phase of 1/65536 cycle as the firmware has them:
    /// 1/65536 turn from neutral, counter-clockwise positive, servo order.
    pub fn table_sweeps(&self, phase: u16) -> [i16; 4] {
        self.gait.sweeps(phase)
    }

    /// The servo angles at a phase of 1/65536 cycle as the firmware has them: deg,
    /// chassis frame, servo order.
    pub fn table_angles(&self, phase: u16) -> [f64; 4] {
        self.gait.angles(phase)
    }

    /// One cycle at full speed from phase 0 on: the time of each frame in s, and
    /// its phase in 1/65536 cycle. The last is the first that completes the cycle.
    pub fn frames(&self) -> impl Iterator<Item = (f64, u16)> + use<> {
        self.gait.frames()
    }

    /// What the check of every sample found.
    pub fn audit(&self) -> &Audit {
        &self.audit
    }

    /// The error of the table over every phase that the firmware can be in.
    pub fn table_error(&self) -> TableError {
        accuracy::worst(&self.gait, accuracy::ALL_PHASES)
    }

    /// Where one cycle takes a robot on this ground, in the time order of a gait
    /// that starts at phase 0, by the contact model. With springs it is the second
    /// cycle, which all later ones repeat.
    ///
    /// Whether it depends on ties is decided with rigid legs, because ties are between pads.
    pub fn predict(&self, ground: &Ground) -> Prediction {
        let known = ground.rigid().predict(self.cycle(COARSE));
        known.known_of(self.walked(ground).travel)
    }

    /// What one cycle does on this ground, whether or not it depends on ties; with
    /// springs the second cycle.
    pub fn walked(&self, ground: &Ground) -> Walked {
        let mut walker = Walker::new(*ground, self.sweeps(self.phase(0.0)));
        let mut steps = STEPS;
        if ground.drive.lags() {
            steps = SPRUNG;
            self.cycle(steps).for_each(|sweeps| {
                walker.step(sweeps);
            });
        }
        let begin = walker.place();
        let mut lag = 0.0;
        for sweeps in self.cycle(steps) {
            walker.step(sweeps);
            lag = walker.lag().into_iter().map(f64::abs).fold(lag, f64::max);
        }
        Walked {
            travel: walker.place().seen_from(begin),
            lag,
        }
    }

    /// One cycle in equal steps of time, its sweeps at both ends among them.
    fn cycle(&self, steps: usize) -> impl Iterator<Item = [f64; 4]> {
        (0..=steps).map(move |i| self.sweeps(self.phase(self.period() * i as f64 / steps as f64)))
    }
}

/// Steps in a cycle; twice as many change no result by 0.01 mm.
const STEPS: usize = 1000;
/// Steps in a cycle of legs on springs, which take longer; four times as many change no
/// result by 0.05 mm.
const SPRUNG: usize = 250;
/// Enough to tell what depends on a tie, which takes longer.
const COARSE: usize = 250;

/// A cycle that was followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walked {
    /// Where it led.
    pub travel: Travel,
    /// How far a leg was behind its servo at most, deg; 0 where legs are rigid.
    pub lag: f64,
}
