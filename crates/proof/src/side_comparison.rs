//! The comparison of the guard with floating point at all pairs of positions that a side's two servos can take, and at
//! all positions of a leg.

use lizard_core::guard::trig::Direction;
use lizard_core::numbers::cells::CellMap;
use lizard_core::numbers::part;
use lizard_kinematics::{End, Lanes, Side, Slider, Vector};
use lizard_robot::{CellMaps, CoreRobot, Robot};

use crate::positions::Positions;
use crate::rows::{Group, gather_lanes, q15_to_sine};
use crate::tally::{LENGTH_BAND_STEPS, LimitKind, MARGIN_BAND, Tally};

/// The comparison of the guard with floating point at all pairs of positions of a side's two servos.
pub struct SideComparison<'a> {
    side: Side,
    cells: CellMap<'a>,
    guard_slider: lizard_core::numbers::slider::Slider,
    float_slider: Slider,
    /// Smallest and largest allowed slider travel, mm.
    stroke_limits: [f64; 2],
    steps_per_mm: f64,
}

impl<'a> SideComparison<'a> {
    /// Prepares the comparison of a side. The guard computes the right side as a mirrored left side.
    pub fn new(robot: &Robot, core_robot: &CoreRobot, maps: &'a CellMaps, side: Side) -> Self {
        let (guard_slider, map) = match side {
            Side::Left => (core_robot.slider(part::Side::Left), &maps.left),
            Side::Right => (core_robot.slider(part::Side::Right).mirrored(), &maps.right),
        };
        Self {
            side,
            cells: map.cells(),
            guard_slider,
            float_slider: robot.lizard().side(side),
            stroke_limits: [robot.limits().stroke_min, robot.limits().stroke_max],
            steps_per_mm: f64::from(1u32 << guard_slider.scale.bits),
        }
    }

    /// Compares the pairs of a row and a group of columns.
    pub fn compare_group(
        &self,
        [front, rear]: [&Positions; 2],
        tally: &mut Tally,
        row: usize,
        (columns, valid_count): Group,
    ) {
        let to_side_frame = |direction: Direction| match self.side {
            Side::Left => direction,
            Side::Right => direction.mirrored(),
        };
        let guard_front_crank = to_side_frame(front.guard_directions[row]);
        let front_arm = Vector::constant(self.side.front_arm(front.float_directions[row]));
        // The directions in `Positions` are in the frame of their end, the arms in the frame of the chassis.
        let float_rear_crank = End::Tail.mirror(gather_lanes(&rear.float_directions, columns));
        let rear_arm = self.side.rear_arm(float_rear_crank);
        let pose = self.float_slider.pose_unchecked(rear_arm, front_arm);
        let (Lanes(d), Lanes(s)) = (pose.d, pose.s);
        for (lane, column) in columns.into_iter().take(valid_count).enumerate() {
            tally.pair_count += 1;
            let guard_rear_crank = to_side_frame(rear.guard_directions[column]);
            let guard_slider = &self.guard_slider;
            let length_sq = guard_slider.length_sq(&guard_front_crank, &guard_rear_crank);
            let length_mm = f64::from(length_sq).sqrt() / self.steps_per_mm;
            Tally::raise(&mut tally.max_slider_error, (length_mm - d[lane]).abs());
            let is_accepted = guard_slider.allows(length_sq);
            let describe_angles = || {
                let [front_deg, rear_deg] = [front.degrees[row], rear.degrees[column]];
                format!("at {front_deg:.4} and {rear_deg:.4} deg")
            };
            if self.cells.contains(front.sweep(row), rear.sweep(column)) {
                tally.count_certified(is_accepted, || {
                    format!("{} side {}", self.side, describe_angles())
                });
            }
            let [min, max] = self.stroke_limits;
            let limit_distance = (s[lane] - min).min(max - s[lane]);
            if is_accepted != (limit_distance >= 0.0) {
                let band_mm = LENGTH_BAND_STEPS / self.steps_per_mm;
                tally.record_difference(LimitKind::Length, limit_distance.abs(), band_mm, || {
                    format!(
                        "{} the slider's length is {length_mm:.5} mm according to the guard, {:.5} mm in floating point",
                        describe_angles(),
                        d[lane]
                    )
                });
            }
        }
    }
}

/// Compares the guard with floating point at all positions of one leg.
pub fn compare_leg(robot: &Robot, core_robot: &CoreRobot, positions: &Positions) -> Tally {
    let mut tally = Tally::default();
    let min_margin = core_robot.limits().leg.0;
    let directions = positions.guard_directions.iter();
    let directions = directions.zip(&positions.float_directions);
    for (position, (guard_direction, float_direction)) in directions.enumerate() {
        tally.pair_count += 1;
        let error = (q15_to_sine(guard_direction.sin) - float_direction.y).abs();
        Tally::raise(&mut tally.max_leg_error, error);
        let limit_distance = float_direction.y - robot.limits().leg;
        if (guard_direction.sin >= min_margin) != (limit_distance >= 0.0) {
            tally.record_difference(LimitKind::Margin, limit_distance.abs(), MARGIN_BAND, || {
                format!("at {:.4} deg", positions.degrees[position])
            });
        }
    }
    tally
}
