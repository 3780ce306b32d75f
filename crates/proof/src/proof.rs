//! The proof of a robot's guard: the findings for all parts of the robot.

use lizard_kinematics::{End, Side};
use lizard_robot::{CoreRobot, Robot};
use serde::Serialize;

use crate::guard_comparison::{self, GuardComparison, PIECE_COUNT};
use crate::rows::PairSample;
use crate::tally::{Finding, Tally};

/// The comparison of guard and geometry for one robot.
#[derive(Clone, Debug, Serialize)]
pub struct Proof {
    /// The findings for ends, sides and legs.
    pub findings: Vec<Finding>,
    /// Hash that identifies the robot's numbers in the firmware.
    pub hash: u32,
    /// The widest band around a margin's limit in which guard and geometry may decide differently, as a sine.
    pub margin_band: f64,
}

impl Proof {
    /// Compares the decisions of the guard with the geometry for a sample of the pairs of servo positions. `core_robot`
    /// has the guard's numbers, normally those of the same robot. Calls `report_progress` with the number of rows
    /// completed since the last call; [`Proof::row_count`] is the total.
    pub fn compute(
        robot: &Robot,
        core_robot: &CoreRobot,
        sample: PairSample,
        report_progress: &(dyn Fn(u64) + Sync),
    ) -> Self {
        let comparison = GuardComparison::new(robot, core_robot, sample);
        let compare_piece = |index| comparison.compare_piece(index, report_progress);
        let tallies = (0..PIECE_COUNT).map(compare_piece).collect();
        Self::from_tallies(robot, core_robot, tallies)
    }

    /// Assembles the proof from the tallies of all pieces, in the order of the pieces.
    pub fn from_tallies(robot: &Robot, core_robot: &CoreRobot, tallies: Vec<Tally>) -> Self {
        Self {
            findings: guard_comparison::compute_findings(robot, core_robot, tallies),
            hash: core_robot.hash(),
            margin_band: guard_comparison::widest_margin_band(robot),
        }
    }

    /// The number of rows that [`Proof::compute`] compares: one for each position of the first servo of each end and
    /// side.
    pub fn row_count(core_robot: &CoreRobot) -> u64 {
        let count_positions = |servo: usize| {
            let calibration = core_robot.calibration()[servo];
            (i32::from(calibration.travel_max.0) - i32::from(calibration.travel_min.0) + 1) as u64
        };
        let first_servos = End::ALL
            .map(|end| end.servos()[0])
            .into_iter()
            .chain(Side::ALL.map(|side| side.servos()[0]));
        first_servos.map(count_positions).sum()
    }

    /// The number of pairs in certified cells of the robot's maps. The firmware accepts them without computing margins.
    pub fn certified_count(&self) -> u64 {
        let tallies = self.findings.iter().map(|finding| &finding.tally);
        tallies.map(|tally| tally.certified_count).sum()
    }

    /// The number of wrong decisions outside the margin band, plus the number of pairs in certified cells that the
    /// guard rejects. A count of 0 over all pairs proves that the guard and the cells are correct.
    pub fn wrong_count(&self) -> u64 {
        let tallies = self.findings.iter().map(|finding| &finding.tally);
        tallies.map(|tally| tally.wrong_count).sum()
    }
}
