//! The tally of errors and differing decisions over many pairs of positions.

use lizard_kinematics::FiveBar;
use serde::{Deserialize, Serialize};

/// Distance (a sine) from a margin's limit within which the guard may decide differently from floating point; see
/// [`margin_band`].
pub const MARGIN_BAND: f64 = 0.002;

/// Distance from a limit of a slider's stroke, or from the position at which the crank tips cross, within which
/// decisions may differ, in steps of the mechanism's lengths. A step is 1/256 mm for a robot of the paper's size.
pub const LENGTH_BAND_STEPS: f64 = 4.0;

/// Distance (a sine) from the limit of a type-2 or type-1 margin within which decisions about an end may differ. It is
/// [`MARGIN_BAND`] or, if larger, the angle by which an error of [`LENGTH_BAND_STEPS`] steps of `step_mm` turns the
/// couplers. The angle is large if the couplers nearly line up: it is inversely proportional to the sine of the angle
/// between the couplers, which is at least `min_type2`.
pub fn margin_band(five_bar: &FiveBar, min_type2: f64, step_mm: f64) -> f64 {
    let (left, right) = (five_bar.left_coupler_length, five_bar.right_coupler_length);
    let max_tip_distance = (left + right)
        .min(five_bar.base + five_bar.left_crank_length + five_bar.right_crank_length);
    let angle_per_mm = (max_tip_distance / (left * right)).max(1.0 / left.min(right));
    MARGIN_BAND.max(LENGTH_BAND_STEPS * step_mm * angle_per_mm / min_type2)
}

/// The kind of a limit at which the decisions about a pair differ.
#[derive(Clone, Copy)]
pub enum LimitKind {
    /// A limit of a slider's stroke, or the position at which the crank tips cross, mm.
    Length,
    /// A margin's limit, a sine.
    Margin,
}

/// The tally of an end, a side or a leg: errors of the guard's values, and decisions that differ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// The number of pairs of positions that were compared.
    pub pair_count: u64,
    /// The number of certified pairs: pairs in a cell of the robot's maps. The guard must accept each of these pairs.
    pub certified_count: u64,
    /// Largest error of the type-2 margin, a sine.
    pub max_type2_error: Option<f64>,
    /// Largest error of a type-1 margin, a sine.
    pub max_type1_error: Option<f64>,
    /// Largest error of a leg's margin, a sine.
    pub max_leg_error: Option<f64>,
    /// Largest error of a slider's length, mm.
    pub max_slider_error: Option<f64>,
    /// Largest distance (a sine) from a margin's limit at which the decisions differ.
    pub max_margin_difference: Option<f64>,
    /// Largest distance from a limit of a slider's stroke, or from the position at which the crank tips cross, at
    /// which the decisions differ, mm.
    pub max_length_difference: Option<f64>,
    /// The number of pairs outside the bands that the guard decides wrongly, plus the number of pairs in a cell that
    /// the guard rejects.
    pub wrong_count: u64,
    /// A description of the first wrong pair.
    pub example: Option<String>,
}

impl Tally {
    /// Raises `max` to `value` if `value` is larger.
    #[inline(always)]
    pub fn raise(max: &mut Option<f64>, value: f64) {
        if max.is_none_or(|max| value > max) {
            *max = Some(value);
        }
    }

    /// Combines two tallies: adds the counts, and keeps the larger errors and the first example.
    pub fn merge(mut self, other: Self) -> Self {
        self.pair_count += other.pair_count;
        self.certified_count += other.certified_count;
        for (max, value) in [
            (&mut self.max_type2_error, other.max_type2_error),
            (&mut self.max_type1_error, other.max_type1_error),
            (&mut self.max_leg_error, other.max_leg_error),
            (&mut self.max_slider_error, other.max_slider_error),
            (&mut self.max_margin_difference, other.max_margin_difference),
            (&mut self.max_length_difference, other.max_length_difference),
        ] {
            if let Some(value) = value {
                Self::raise(max, value);
            }
        }
        self.wrong_count += other.wrong_count;
        self.example = self.example.or(other.example);
        self
    }

    /// Counts a pair in a cell. The pair is wrong if the guard rejects it.
    #[inline(always)]
    pub fn count_certified(&mut self, is_accepted: bool, describe_pair: impl FnOnce() -> String) {
        self.certified_count += 1;
        if !is_accepted {
            self.wrong_count += 1;
            self.example.get_or_insert_with(|| {
                format!("{}: in a cell, but the guard rejects it", describe_pair())
            });
        }
    }

    /// Records a pair at which the decisions differ, at `distance` from a limit of this kind. The pair is wrong if
    /// `distance` exceeds `band`; both are in the limit's unit.
    #[cold]
    pub fn record_difference(
        &mut self,
        kind: LimitKind,
        distance: f64,
        band: f64,
        describe_pair: impl FnOnce() -> String,
    ) {
        let max_distance = match kind {
            LimitKind::Length => &mut self.max_length_difference,
            LimitKind::Margin => &mut self.max_margin_difference,
        };
        Self::raise(max_distance, distance);
        if distance > band {
            self.wrong_count += 1;
            self.example.get_or_insert_with(describe_pair);
        }
    }
}

/// The result of comparing the guard with floating point at one end, one side or one leg.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// `head`, `tail`, `left side`, `right side`, or a leg such as `leg LF`.
    pub part: String,
    /// The servos that move the part.
    pub servos: Vec<&'static str>,
    /// The tally over the positions of these servos.
    #[serde(flatten)]
    pub tally: Tally,
}
