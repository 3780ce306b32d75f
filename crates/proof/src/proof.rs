//! The proof of a robot's guard: the findings of all its parts.

use lizard_robot::{CoreRobot, Robot};
use serde::Serialize;

use crate::rows::PairSample;
use crate::tally::{Finding, Tally};
use crate::walk;

/// The comparison of guard and geometry for one robot.
#[derive(Clone, Debug, Serialize)]
pub struct Proof {
    /// The findings for ends, sides and legs.
    pub findings: Vec<Finding>,
    /// Hash that identifies the robot's numbers.
    pub hash: u32,
    /// Distance from a margin's limit within which the decisions may differ, a sine.
    pub margin_band: f64,
}

impl Proof {
    /// Compares a share of the pairs of a robot with a guard, normally the robot's own. `progress` is called with the
    /// number of rows completed since its last call; [`Proof::rows`] returns their total.
    pub fn of(
        robot: &Robot,
        guard: &CoreRobot,
        sample: PairSample,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Self {
        let walk = walk::Walk::new(robot, guard, sample);
        let check_piece = |index| walk.piece(index, progress);
        Self::from_tallies(robot, guard, (0..walk::PIECES).map(check_piece).collect())
    }

    /// Makes the proof from the tallies of all pieces, in order.
    pub fn from_tallies(robot: &Robot, guard: &CoreRobot, pieces: Vec<Tally>) -> Self {
        Self {
            findings: walk::findings(robot, guard, pieces),
            hash: guard.hash(),
            margin_band: walk::widest_band(robot),
        }
    }

    /// The number of rows that [`Proof::of`] walks.
    pub fn rows(guard: &CoreRobot) -> u64 {
        walk::rows(guard)
    }

    /// The number of pairs in cells of the robot's maps, whose poses the firmware does not measure.
    pub fn certified(&self) -> u64 {
        self.findings
            .iter()
            .map(|finding| finding.tally.certified_count)
            .sum()
    }

    /// The number of wrong decisions outside the bands, plus the number of poses in a cell that the guard refuses.
    /// If it is 0, guard and cells are proved correct.
    pub fn wrong(&self) -> u64 {
        self.findings
            .iter()
            .map(|finding| finding.tally.wrong_count)
            .sum()
    }
}
