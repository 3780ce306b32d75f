//! The five-bar linkages of a sample robot's head and tail, with the tables of their couplers.

use lizard_avr::Flash;
use lizard_kinematics as kinematics;

use crate::guard::five_bar::FiveBar;
use crate::numbers::couplers::{self, CouplerLengths, Couplers};
use crate::numbers::curve::Table;
use crate::numbers::link_lengths;
use crate::numbers::section::FiveBarLengths;
use crate::numbers::units::Scale;
use crate::sample::steps_per_mm;

/// The five-bar linkage of an end (head or tail), with the tables of its couplers.
#[derive(Clone, Debug)]
pub struct SampleFiveBar {
    /// The lengths that a section stores.
    pub lengths: FiveBarLengths,
    couplers: SampleCouplers,
}

/// The lengths of both couplers, in steps, and their tables.
#[derive(Clone, Debug)]
pub struct SampleCouplers {
    left: i16,
    right: i16,
    rise: Table,
    stretched_rise: Table,
    folded_rise: Option<Table>,
    skew: Option<Table>,
}

impl SampleCouplers {
    /// Creates couplers of these lengths, in steps, and their tables.
    pub fn new(left: i16, right: i16) -> Self {
        Self {
            left,
            right,
            rise: couplers::compute_rise_table(left, right),
            stretched_rise: couplers::compute_stretched_rise_table(left, right),
            folded_rise: Couplers::needs_folded_table(left, right)
                .then(|| couplers::compute_folded_rise_table(left, right)),
            skew: (left != right).then(|| couplers::compute_skew_table(left, right)),
        }
    }

    /// Converts the couplers to the type that the guard uses.
    pub fn couplers(&self) -> Couplers<'_> {
        Couplers::new(CouplerLengths::new(self.left, self.right), self.tables())
    }

    fn tables(&self) -> couplers::CouplerTables<'_> {
        couplers::CouplerTables {
            rise: Some(Flash::from(&self.rise)),
            stretched_rise: Some(Flash::from(&self.stretched_rise)),
            folded_rise: self.folded_rise.as_ref().map(Flash::from),
            skew: self.skew.as_ref().map(Flash::from),
        }
    }
}

impl SampleFiveBar {
    /// Converts a five-bar from mm to the finest steps with which each coupler, and the sum of base and cranks, is
    /// below [`link_lengths::MAX_LENGTH_STEPS`]. Returns `None` if even steps of 1 mm are too fine, or if a coupler is
    /// shorter than [`link_lengths::MIN_COUPLER_STEPS`].
    pub fn new(five_bar: &kinematics::FiveBar) -> Option<Self> {
        let [base, left, right] = [
            five_bar.base,
            five_bar.left_crank_length,
            five_bar.right_crank_length,
        ];
        let couplers = [five_bar.left_coupler_length, five_bar.right_coupler_length];
        let longest_mm = couplers.iter().copied().fold(base + left + right, f64::max);
        let scale = (0..=14)
            .rev()
            .map(|bits| Scale { bits })
            .find(|scale| longest_mm * steps_per_mm(*scale) < link_lengths::MAX_LENGTH_STEPS)?;
        let to_length = |mm: f64| to_steps(mm, scale) as i16;
        let lengths = FiveBarLengths {
            scale,
            base: to_length(base),
            cranks: [left, right].map(to_length),
            couplers: couplers.map(to_length),
            can_nearly_stretch: true,
        };
        let [left_coupler, right_coupler] = lengths.couplers;
        (left_coupler.min(right_coupler) >= link_lengths::MIN_COUPLER_STEPS).then(|| Self {
            lengths,
            couplers: SampleCouplers::new(left_coupler, right_coupler),
        })
    }

    /// Converts the five-bar to the type that the guard uses.
    pub fn five_bar(&self) -> FiveBar<'_> {
        FiveBar::new(self.lengths.link_lengths(), self.couplers.tables())
    }
}

/// Rounds a length to whole steps.
pub(super) fn to_steps(mm: f64, scale: Scale) -> i32 {
    (mm * steps_per_mm(scale)).round() as i32
}
