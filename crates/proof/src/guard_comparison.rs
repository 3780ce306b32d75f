//! Compares the guard's decisions with floating point at the pairs of servo positions of every end and side. The
//! comparison is divided into pieces.

use std::sync::OnceLock;

use lizard_kinematics::{End, Side};
use lizard_robot::{CellMaps, CoreRobot, Robot, servo};

use crate::end_comparison::{EndComparison, compute_bands};
use crate::positions::Positions;
use crate::rows::{CompareGroup, PIECES_PER_PART, PairSample, tally_rows};
use crate::side_comparison::{SideComparison, compare_leg};
use crate::tally::{Finding, MARGIN_BAND, Tally};

/// Number of pieces of the whole comparison: 64 for each end and each side.
pub const PIECE_COUNT: usize = 4 * PIECES_PER_PART;

/// The comparison of a robot's guard with floating point at pairs of servo positions. Holds the values that all pieces
/// share.
pub struct GuardComparison<'a> {
    robot: &'a Robot,
    core_robot: &'a CoreRobot,
    sample: PairSample,
    maps: CellMaps,
    /// The positions of each servo, computed when the first piece needs them.
    positions: [OnceLock<Positions>; 4],
}

impl<'a> GuardComparison<'a> {
    /// Creates the comparison over a sample of the pairs.
    pub fn new(robot: &'a Robot, core_robot: &'a CoreRobot, sample: PairSample) -> Self {
        Self {
            robot,
            core_robot,
            sample,
            maps: robot.cell_maps(),
            positions: Default::default(),
        }
    }

    /// The positions of the servo with this index, 0 to 3.
    fn positions(&self, servo: usize) -> &Positions {
        self.positions[servo].get_or_init(|| Positions::compute(self.core_robot, servo))
    }

    /// Compares the pairs of one piece, whose index is below [`PIECE_COUNT`]. Calls `report_progress` with the number
    /// of rows completed since the last call.
    pub fn compare_piece(&self, index: usize, report_progress: &(dyn Fn(u64) + Sync)) -> Tally {
        let part_index = index / PIECES_PER_PART;
        let piece_in_part = index % PIECES_PER_PART;
        let tally_servos = |servos: [usize; 2], compare_group: &CompareGroup<'_>| {
            tally_rows(
                servos.map(|servo| self.positions(servo)),
                self.sample,
                piece_in_part,
                report_progress,
                compare_group,
            )
        };
        if let Some(end) = End::ALL.get(part_index) {
            let comparison = EndComparison::new(self.robot, self.core_robot, &self.maps, *end);
            tally_servos(end.servos(), &|positions, tally, row, group| {
                comparison.compare_group(positions, tally, row, group);
            })
        } else {
            let side = Side::ALL[part_index - End::ALL.len()];
            let comparison = SideComparison::new(self.robot, self.core_robot, &self.maps, side);
            tally_servos(side.servos(), &|positions, tally, row, group| {
                comparison.compare_group(positions, tally, row, group);
            })
        }
    }
}

/// Computes the findings for every end, side and leg of a robot from the tallies of all pieces, in order.
pub fn compute_findings(
    robot: &Robot,
    core_robot: &CoreRobot,
    tallies: Vec<Tally>,
) -> Vec<Finding> {
    let mut tallies = tallies.into_iter();
    let mut next_part_tally = || {
        tallies
            .by_ref()
            .take(PIECES_PER_PART)
            .fold(Tally::default(), Tally::merge)
    };
    let ends = End::ALL.map(|end| (end.name().to_string(), end.servos()));
    let sides = Side::ALL.map(|side| (format!("{side} side"), side.servos()));
    let parts = ends.into_iter().chain(sides);
    let to_finding = |(part, servos): (String, [usize; 2])| Finding {
        part,
        servos: servos.map(|servo| servo::SERVO_NAMES[servo]).to_vec(),
        tally: next_part_tally(),
    };
    let mut findings: Vec<Finding> = parts.map(to_finding).collect();
    for (servo, leg_name) in servo::LEG_NAMES.iter().enumerate() {
        let positions = Positions::compute(core_robot, servo);
        findings.push(Finding {
            part: format!("leg {leg_name}"),
            servos: vec![servo::SERVO_NAMES[servo]],
            tally: compare_leg(robot, core_robot, &positions),
        });
    }
    findings
}

/// Returns the larger margin band of the two ends, at least [`MARGIN_BAND`]. Within this distance from a margin's
/// limit, which is a sine, the guard may decide differently from floating point.
pub fn widest_margin_band(robot: &Robot) -> f64 {
    let bands = End::ALL.map(|end| compute_bands(robot, end)[0]);
    bands.into_iter().fold(MARGIN_BAND, f64::max)
}
