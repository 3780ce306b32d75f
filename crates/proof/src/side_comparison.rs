//! The comparison of the guard with floating point at all pairs of positions that a side's two servos can take, and at
//! all positions of a leg.

use lizard_core::guard::trig::Direction;
use lizard_core::numbers::cells::CellMap;
use lizard_core::numbers::part;
use lizard_kinematics::{End, Lanes, Side, Slider, Vector};
use lizard_robot::{CellMaps, CoreRobot, Robot};

use crate::positions::Positions;
use crate::rows::{
    PairSample, for_each_group, gather_lanes, q15_to_sine, select_columns, tally_rows,
};
use crate::tally::{LENGTH_BAND_STEPS, MARGIN_BAND, Tally};

/// The comparison of the guard with floating point over all pairs of a side.
pub struct SideComparison<'a> {
    side: Side,
    cells: CellMap<'a>,
    fixed: lizard_core::numbers::slider::Slider,
    exact: Slider,
    /// Smallest and largest allowed slider travel, mm.
    stroke_limits: [f64; 2],
    steps_per_mm: f64,
}

impl<'a> SideComparison<'a> {
    pub fn new(robot: &Robot, guard: &CoreRobot, maps: &'a CellMaps, side: Side) -> Self {
        let (fixed, map) = match side {
            Side::Left => (guard.slider(part::Side::Left), &maps.left),
            Side::Right => (guard.slider(part::Side::Right).mirrored(), &maps.right),
        };
        Self {
            side,
            cells: map.cells(),
            fixed,
            exact: robot.lizard().side(side),
            stroke_limits: [robot.limits().stroke_min, robot.limits().stroke_max],
            steps_per_mm: f64::from(1u32 << fixed.scale.bits),
        }
    }

    /// Compares the selected pairs in one piece of the rows.
    pub fn compare_piece(
        &self,
        [front, rear]: [&Positions; 2],
        sample: PairSample,
        piece_index: usize,
        report_progress: &(dyn Fn(u64) + Sync),
    ) -> Tally {
        let to_side_frame = |direction: Direction| match self.side {
            Side::Left => direction,
            Side::Right => direction.mirrored(),
        };
        let band_mm = LENGTH_BAND_STEPS / self.steps_per_mm;
        tally_rows(front, piece_index, report_progress, |row| {
            let mut tally = Tally::default();
            let crank = to_side_frame(front.fixed[row]);
            let front_arm = Vector::constant(self.side.front_arm(front.exact[row]));
            for_each_group(
                select_columns(sample, row, rear.fixed.len()),
                |group, count| {
                    // Positions are in the frame of their end, arms in the frame of the chassis.
                    let crank_rear = End::Tail.mirror(gather_lanes(&rear.exact, group));
                    let pose = self
                        .exact
                        .pose_unchecked(self.side.rear_arm(crank_rear), front_arm);
                    let (Lanes(d), Lanes(s)) = (pose.d, pose.s);
                    for lane in 0..count {
                        let column = group[lane];
                        tally.pair_count += 1;
                        let length_sq = self
                            .fixed
                            .length_sq(&crank, &to_side_frame(rear.fixed[column]));
                        let length_mm = f64::from(length_sq).sqrt() / self.steps_per_mm;
                        Tally::raise(&mut tally.max_slider_error, (length_mm - d[lane]).abs());
                        let is_allowed = self.fixed.allows(length_sq);
                        if self.cells.contains(front.sweep(row), rear.sweep(column)) {
                            tally.count_certified(is_allowed, || {
                                format!(
                                    "{} side at {:.4} and {:.4} deg",
                                    self.side, front.degrees[row], rear.degrees[column]
                                )
                            });
                        }
                        let [min, max] = self.stroke_limits;
                        let limit_distance = (s[lane] - min).min(max - s[lane]);
                        if is_allowed != (limit_distance >= 0.0) {
                            tally.record_difference(true, limit_distance.abs(), band_mm, || {
                            format!(
                                "at {:.4} and {:.4} deg the slider's length is {length_mm:.5} mm according to the guard, {:.5} mm in floating point",
                                front.degrees[row], rear.degrees[column], d[lane]
                            )
                        });
                        }
                    }
                },
            );
            tally
        })
    }
}

/// Compares the guard with floating point at all positions of one leg.
pub fn compare_leg(robot: &Robot, guard: &CoreRobot, positions: &Positions) -> Tally {
    let mut tally = Tally::default();
    let min_margin = guard.limits().leg.0;
    for (position, (fixed, exact)) in positions.fixed.iter().zip(&positions.exact).enumerate() {
        tally.pair_count += 1;
        Tally::raise(
            &mut tally.max_leg_error,
            (q15_to_sine(fixed.sin) - exact.y).abs(),
        );
        let limit_distance = exact.y - robot.limits().leg;
        if (fixed.sin >= min_margin) != (limit_distance >= 0.0) {
            tally.record_difference(false, limit_distance.abs(), MARGIN_BAND, || {
                format!("at {:.4} deg", positions.degrees[position])
            });
        }
    }
    tally
}
