//! The comparison of the guard with floating point at all pairs of positions that an end's two servos can take.

use lizard_core::guard::five_bar::EndMargins;
use lizard_core::guard::trig::Direction;
use lizard_core::numbers::cells::CellMap;
use lizard_core::numbers::part;
use lizard_kinematics::{AssemblyMode, End, FiveBar, Lanes, Vector};
use lizard_robot::{CellMaps, CoreRobot, Robot};

use crate::positions::Positions;
use crate::rows::{Group, gather_lanes, q15_to_sine};
use crate::tally::{LENGTH_BAND_STEPS, LimitKind, Tally, margin_band};

/// The comparison of the guard with floating point at all pairs of positions of an end's two servos.
pub struct EndComparison<'a> {
    guard_five_bar: lizard_core::guard::five_bar::FiveBar<'a>,
    float_five_bar: FiveBar,
    /// Smallest allowed type-2 and type-1 margins of robot.toml, sines.
    limits: [f64; 2],
    /// Smallest allowed type-2 and type-1 margins in the firmware, Q15.
    guard_limits: [i16; 2],
    /// Smallest allowed leg margin in the firmware, Q15.
    guard_leg_limit: i16,
    end: End,
    cells: CellMap<'a>,
    /// Distance from a margin's limit within which decisions may differ, a sine.
    margin_band: f64,
    /// Distance of the crank tips from crossing within which decisions may differ.
    crossing_band_mm: f64,
}

impl<'a> EndComparison<'a> {
    /// Prepares the comparison of an end.
    pub fn new(robot: &Robot, core_robot: &'a CoreRobot, maps: &'a CellMaps, end: End) -> Self {
        let limits = core_robot.limits();
        let [margin_band, crossing_band_mm] = compute_bands(robot, end);
        let map = match end {
            End::Head => &maps.head,
            End::Tail => &maps.tail,
        };
        Self {
            guard_five_bar: core_robot.five_bar(part::End::ALL[end as usize]),
            float_five_bar: robot.lizard().end(end),
            limits: [robot.limits().type2, robot.limits().type1],
            guard_limits: [limits.type2.0, limits.type1.0],
            guard_leg_limit: limits.leg.0,
            end,
            cells: map.cells(),
            margin_band,
            crossing_band_mm,
        }
    }

    /// Compares the pairs of a row and a group of columns.
    pub fn compare_group(
        &self,
        [left, right]: [&Positions; 2],
        tally: &mut Tally,
        row: usize,
        (columns, valid_count): Group,
    ) {
        let crank_left = Vector::constant(left.float_directions[row]);
        let crank_right = gather_lanes(&right.float_directions, columns);
        let mode = AssemblyMode::Ahead;
        let five_bar = &self.float_five_bar;
        let pose = five_bar.pose_unchecked(mode, crank_left, crank_right);
        let are_closed = five_bar.are_loops_closed(&pose);
        let Lanes(type2) = pose.type2;
        let Lanes(type1_left) = pose.type1_left();
        let Lanes(type1_right) = pose.type1_right();
        let Lanes(crank_tip_distance_mm) = pose.gap.x;
        for (lane, column) in columns.into_iter().take(valid_count).enumerate() {
            let float_values = FloatEndValues {
                is_closed: are_closed[lane],
                type2: type2[lane],
                type1: [type1_left[lane], type1_right[lane]],
                crank_tip_distance_mm: crank_tip_distance_mm[lane],
            };
            let cranks = [left.guard_directions[row], right.guard_directions[column]];
            let margins = self.guard_five_bar.margins(&cranks[0], &cranks[1]);
            let describe_pair = || {
                let name = self.end.name();
                let [left_deg, right_deg] = [left.degrees[row], right.degrees[column]];
                format!("{name} at {left_deg:.4} and {right_deg:.4} deg")
            };
            self.compare_pair(tally, margins, &float_values, describe_pair);
            let [left_sweep, right_sweep] = [left.sweep(row), right.sweep(column)];
            // The maps' rows are the sweeps of A1 and A3, their columns the sweeps of A2 and A4.
            let is_in_cell = match self.end {
                End::Head => self.cells.contains(left_sweep, right_sweep),
                End::Tail => self.cells.contains(right_sweep, left_sweep),
            };
            if is_in_cell {
                let is_leg_accepted = |crank: &Direction| crank.sin >= self.guard_leg_limit;
                let are_legs_accepted = cranks.iter().all(is_leg_accepted);
                let is_accepted = self.accepts(margins) && are_legs_accepted;
                tally.count_certified(is_accepted, describe_pair);
            }
        }
    }

    /// True if the guard accepts an end with these margins.
    #[inline(always)]
    fn accepts(&self, margins: EndMargins) -> bool {
        let [type2, type1] = self.guard_limits;
        margins.type2.0 >= type2 && margins.type1_left.0 >= type1 && margins.type1_right.0 >= type1
    }

    /// Compares the guard's margins of a pair with those in floating point.
    #[inline(always)]
    fn compare_pair(
        &self,
        tally: &mut Tally,
        margins: EndMargins,
        float_values: &FloatEndValues,
        describe_pair: impl Fn() -> String,
    ) {
        tally.pair_count += 1;
        let is_accepted = self.accepts(margins);
        let type2 = q15_to_sine(margins.type2.0);
        let type1 = [margins.type1_left, margins.type1_right].map(|margin| q15_to_sine(margin.0));
        // The guard rejects other poses in any case: the loop does not close, or the type-2 margin is too small.
        if float_values.is_closed && float_values.type2 > self.limits[0] - self.margin_band {
            let type2_error = (type2.abs() - float_values.type2).abs();
            Tally::raise(&mut tally.max_type2_error, type2_error);
            for (margin, float_margin) in type1.into_iter().zip(float_values.type1) {
                Tally::raise(&mut tally.max_type1_error, (margin - float_margin).abs());
            }
        }
        let margin_distance = float_values.distance_from_limits(self.limits);
        let crossing_distance_mm = float_values.crank_tip_distance_mm;
        let is_safe = margin_distance >= 0.0 && crossing_distance_mm > 0.0;
        if is_accepted != is_safe {
            // The difference is attributed to the limit that is nearer relative to its band.
            let is_from_crossing =
                crossing_distance_mm / self.crossing_band_mm < margin_distance / self.margin_band;
            let (kind, distance, band) = if is_from_crossing {
                let distance_mm = crossing_distance_mm.abs();
                (LimitKind::Length, distance_mm, self.crossing_band_mm)
            } else {
                (LimitKind::Margin, margin_distance.abs(), self.margin_band)
            };
            tally.record_difference(kind, distance, band, || {
                format!(
                    "{}: {} according to the guard, {} in floating point: margins {:.5} {:.5} {:.5}, in floating point {:.5} {:.5} {:.5}, distance across from tip to tip {:+.4} mm",
                    describe_pair(),
                    if is_accepted { "safe" } else { "unsafe" },
                    if is_safe { "safe" } else { "unsafe" },
                    type2,
                    type1[0],
                    type1[1],
                    float_values.type2,
                    float_values.type1[0],
                    float_values.type1[1],
                    crossing_distance_mm,
                )
            });
        }
    }
}

/// The values of an end at a pair of positions, in floating point.
struct FloatEndValues {
    /// True if the loop closes.
    is_closed: bool,
    /// The type-2 margin, a sine.
    type2: f64,
    /// The left and right type-1 margins, sines.
    type1: [f64; 2],
    /// The distance from the left crank tip to the right one across the end, mm; negative if the tips have crossed.
    crank_tip_distance_mm: f64,
}

impl FloatEndValues {
    /// The distance of the smallest margin from its limit, a sine; negative beyond the limit.
    #[inline(always)]
    fn distance_from_limits(&self, [min_type2, min_type1]: [f64; 2]) -> f64 {
        if !self.is_closed {
            return -min_type2;
        }
        let type1_distance = self.type1[0].min(self.type1[1]) - min_type1;
        (self.type2 - min_type2).min(type1_distance)
    }
}

/// Computes an end's bands in which decisions may differ: the distance from a margin's limit, a sine, and the distance
/// from the crossing of the crank tips, mm.
pub fn compute_bands(robot: &Robot, end: End) -> [f64; 2] {
    let step_mm = f64::from(1u32 << robot.content().ends[end as usize].scale.bits).recip();
    let band = margin_band(&robot.lizard().end(end), robot.limits().type2, step_mm);
    [band, LENGTH_BAND_STEPS * step_mm]
}
