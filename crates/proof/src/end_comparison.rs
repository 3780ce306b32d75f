//! The comparison of the guard with floating point at all pairs of positions that an end's two servos can take.

use lizard_core::guard::five_bar::EndMargins;
use lizard_core::numbers::cells::CellMap;
use lizard_core::numbers::part;
use lizard_kinematics::{AssemblyMode, End, FiveBar, Lanes, Vector};
use lizard_robot::{CellMaps, CoreRobot, Robot};

use crate::positions::Positions;
use crate::rows::{
    PairSample, for_each_group, gather_lanes, q15_to_sine, select_columns, tally_rows,
};
use crate::tally::{LENGTH_BAND_STEPS, Tally, margin_band};

/// The comparison of the guard with floating point over all pairs of an end.
pub struct EndComparison<'a> {
    fixed: lizard_core::guard::five_bar::FiveBar<'a>,
    exact: FiveBar,
    /// Smallest allowed type-2 and type-1 margins of robot.toml, sines.
    limits: [f64; 2],
    /// Smallest allowed type-2 and type-1 margins in the firmware, Q15.
    fixed_limits: [i16; 2],
    /// Smallest allowed leg margin in the firmware, Q15.
    fixed_leg_limit: i16,
    end: End,
    cells: CellMap<'a>,
    /// Distance from a margin's limit within which decisions may differ, a sine.
    margin_band: f64,
    /// Distance of the crank tips from crossing within which decisions may differ.
    crossing_band_mm: f64,
}

impl<'a> EndComparison<'a> {
    pub fn new(robot: &Robot, guard: &'a CoreRobot, maps: &'a CellMaps, end: End) -> Self {
        let limits = guard.limits();
        let [margin_band, crossing_band_mm] = compute_bands(robot, end);
        let map = match end {
            End::Head => &maps.head,
            End::Tail => &maps.tail,
        };
        Self {
            fixed: guard.five_bar(part::End::ALL[end as usize]),
            exact: robot.lizard().end(end),
            limits: [robot.limits().type2, robot.limits().type1],
            fixed_limits: [limits.type2.0, limits.type1.0],
            fixed_leg_limit: limits.leg.0,
            end,
            cells: map.cells(),
            margin_band,
            crossing_band_mm,
        }
    }

    /// Compares the selected pairs in one piece of the rows.
    pub fn compare_piece(
        &self,
        [left, right]: [&Positions; 2],
        sample: PairSample,
        piece_index: usize,
        report_progress: &(dyn Fn(u64) + Sync),
    ) -> Tally {
        tally_rows(left, piece_index, report_progress, |row| {
            let mut tally = Tally::default();
            let crank_left = Vector::constant(left.exact[row]);
            for_each_group(
                select_columns(sample, row, right.fixed.len()),
                |group, count| {
                    let crank_right = gather_lanes(&right.exact, group);
                    let pose =
                        self.exact
                            .pose_unchecked(AssemblyMode::Ahead, crank_left, crank_right);
                    let are_closed = self.exact.closes(&pose);
                    let Lanes(type2) = pose.type2;
                    let Lanes(type1_left) = pose.type1_left();
                    let Lanes(type1_right) = pose.type1_right();
                    let Lanes(gap_across_mm) = pose.gap.x;
                    for lane in 0..count {
                        let column = group[lane];
                        let exact = ExactEndValues {
                            is_closed: are_closed[lane],
                            type2: type2[lane],
                            type1: [type1_left[lane], type1_right[lane]],
                            crank_tip_distance_mm: gap_across_mm[lane],
                        };
                        let margins = self.fixed.margins(&left.fixed[row], &right.fixed[column]);
                        let describe_pair = || {
                            format!(
                                "{} at {:.4} and {:.4} deg",
                                self.end.name(),
                                left.degrees[row],
                                right.degrees[column]
                            )
                        };
                        self.compare_pair(&mut tally, margins, &exact, describe_pair);
                        let [left_sweep, right_sweep] = [left.sweep(row), right.sweep(column)];
                        // The maps' rows are the sweeps of A1 and A3, their columns the sweeps of A2 and A4.
                        let is_in_cell = match self.end {
                            End::Head => self.cells.contains(left_sweep, right_sweep),
                            End::Tail => self.cells.contains(right_sweep, left_sweep),
                        };
                        if is_in_cell {
                            let legs = [left.fixed[row], right.fixed[column]];
                            let is_accepted = self.accepts(margins)
                                && legs.iter().all(|leg| leg.sin >= self.fixed_leg_limit);
                            tally.count_certified(is_accepted, describe_pair);
                        }
                    }
                },
            );
            tally
        })
    }

    /// True if the guard accepts an end with these margins.
    #[inline(always)]
    fn accepts(&self, margins: EndMargins) -> bool {
        let [type2, type1] = self.fixed_limits;
        margins.type2.0 >= type2 && margins.type1_left.0 >= type1 && margins.type1_right.0 >= type1
    }

    /// Compares the guard's margins of a pair with their exact values.
    #[inline(always)]
    fn compare_pair(
        &self,
        tally: &mut Tally,
        margins: EndMargins,
        exact: &ExactEndValues,
        describe_pair: impl Fn() -> String,
    ) {
        tally.pair_count += 1;
        let is_fixed_safe = self.accepts(margins);
        let EndMargins {
            type2,
            type1_left,
            type1_right,
        } = margins;
        // A pose whose couplers nearly fold is rejected, regardless of its other margins.
        if exact.is_closed && exact.type2 > self.limits[0] - self.margin_band {
            Tally::raise(
                &mut tally.max_type2_error,
                (q15_to_sine(type2.0).abs() - exact.type2).abs(),
            );
            for (fixed, exact) in [type1_left, type1_right].into_iter().zip(exact.type1) {
                Tally::raise(
                    &mut tally.max_type1_error,
                    (q15_to_sine(fixed.0) - exact).abs(),
                );
            }
        }
        let (margin_distance, crossing_distance_mm) = exact.distances_from_limits(self.limits);
        let is_exact_safe = margin_distance >= 0.0 && crossing_distance_mm > 0.0;
        if is_fixed_safe != is_exact_safe {
            // The difference is attributed to the limit that is nearer relative to its band.
            let is_from_crossing =
                crossing_distance_mm / self.crossing_band_mm < margin_distance / self.margin_band;
            let (distance, band) = if is_from_crossing {
                (crossing_distance_mm.abs(), self.crossing_band_mm)
            } else {
                (margin_distance.abs(), self.margin_band)
            };
            tally.record_difference(is_from_crossing, distance, band, || {
                format!(
                    "{}: {} according to the guard, {} in floating point: margins {:.5} {:.5} {:.5}, exactly {:.5} {:.5} {:.5}, distance across from tip to tip {:+.4} mm",
                    describe_pair(),
                    if is_fixed_safe { "safe" } else { "unsafe" },
                    if is_exact_safe { "safe" } else { "unsafe" },
                    q15_to_sine(type2.0),
                    q15_to_sine(type1_left.0),
                    q15_to_sine(type1_right.0),
                    exact.type2,
                    exact.type1[0],
                    exact.type1[1],
                    exact.crank_tip_distance_mm,
                )
            });
        }
    }
}

/// The values of an end at a pair of positions, in floating point.
struct ExactEndValues {
    /// True if the loop closes.
    is_closed: bool,
    /// The type-2 margin, a sine.
    type2: f64,
    /// The left and right type-1 margins, sines.
    type1: [f64; 2],
    /// The distance from the left crank tip to the right one across the end, mm.
    crank_tip_distance_mm: f64,
}

impl ExactEndValues {
    /// The distance of the smallest margin from its limit, a sine, and the distance of the crank tips from crossing,
    /// mm. Both are negative beyond the limit.
    #[inline(always)]
    fn distances_from_limits(&self, [min_type2, min_type1]: [f64; 2]) -> (f64, f64) {
        if !self.is_closed {
            return (-min_type2, self.crank_tip_distance_mm);
        }
        let type1 = self.type1[0].min(self.type1[1]) - min_type1;
        (
            (self.type2 - min_type2).min(type1),
            self.crank_tip_distance_mm,
        )
    }
}

/// Computes an end's bands in which decisions may differ: the distance from a margin's limit, a sine, and the distance
/// from the crossing of the crank tips, mm.
pub fn compute_bands(robot: &Robot, end: End) -> [f64; 2] {
    let step_mm = f64::from(1u32 << robot.content().ends[end as usize].scale.bits).recip();
    let band = margin_band(&robot.lizard().end(end), robot.limits().type2, step_mm);
    [band, LENGTH_BAND_STEPS * step_mm]
}
