//! The five-bar linkages of a sample robot's head and tail, with the tables of their couplers.

use lizard_avr::Flash;
use lizard_kinematics as kinematics;

use crate::guard::five_bar::FiveBar;
use crate::numbers::bars;
use crate::numbers::couplers::{self, Couplers, Coupling};
use crate::numbers::curve::Table;
use crate::numbers::section;
use crate::numbers::units::Scale;

/// One five-bar linkage, head or tail, with the tables of its couplers. Its lengths are in steps.
#[derive(Clone, Debug)]
pub struct SampleFiveBar {
    /// The base, the left and the right crank. Their sum is the largest distance between the crank tips.
    pub bars: [i16; 3],
    pub scale: Scale,
    pub couplers: SampleCouplers,
}

/// Both couplers, in steps, and their tables.
#[derive(Clone, Debug)]
pub struct SampleCouplers {
    pub left: i16,
    pub right: i16,
    rise: Table,
    stretched: Table,
    folded: Option<Table>,
    skew: Option<Table>,
}

impl SampleCouplers {
    pub fn new(left: i16, right: i16) -> Self {
        let are_unequal = left != right;
        Self {
            left,
            right,
            rise: couplers::rise(left, right),
            stretched: couplers::stretched(left, right),
            folded: Couplers::differ_much(left, right).then(|| couplers::folded(left, right)),
            skew: are_unequal.then(|| couplers::skew(left, right)),
        }
    }

    pub fn couplers(&self) -> Couplers<'_> {
        Couplers::new(Coupling::new(self.left, self.right), self.tables())
    }

    fn tables(&self) -> couplers::Tables<'_> {
        couplers::Tables {
            rise: Some(Flash::from(&self.rise)),
            stretched: Some(Flash::from(&self.stretched)),
            folded: self.folded.as_ref().map(Flash::from),
            skew: self.skew.as_ref().map(Flash::from),
        }
    }
}

impl SampleFiveBar {
    /// Converts bars from mm to the finest steps in which each coupler and the sum of the other bars are below
    /// [`bars::MAX_STEPS`]; `None` if even steps of 1 mm are too fine, or if a coupler is shorter than
    /// [`bars::MIN_COUPLER`] then.
    pub fn new(bars: &kinematics::FiveBar) -> Option<Self> {
        let [base, left, right] = [bars.base, bars.crank_left, bars.crank_right];
        let couplers = [bars.coupler_left, bars.coupler_right];
        let longest_mm = couplers.iter().copied().fold(base + left + right, f64::max);
        let scale = (0..=14)
            .rev()
            .map(|bits| Scale { bits })
            .find(|scale| longest_mm * per_mm(*scale) < bars::MAX_STEPS)?;
        let [left_steps, right_steps] = couplers.map(|mm| steps(mm, scale) as i16);
        if left_steps.min(right_steps) < bars::MIN_COUPLER {
            return None;
        }
        Some(Self {
            bars: [base, left, right].map(|mm| steps(mm, scale) as i16),
            scale,
            couplers: SampleCouplers::new(left_steps, right_steps),
        })
    }

    /// The five-bar as the content of a section.
    pub(super) fn content(&self) -> section::Loop {
        let [base, left, right] = self.bars;
        section::Loop {
            scale: self.scale,
            base,
            cranks: [left, right],
            couplers: [self.couplers.left, self.couplers.right],
            is_near_stretched: true,
        }
    }

    pub fn five_bar(&self) -> FiveBar<'_> {
        let SampleCouplers { left, right, .. } = self.couplers;
        let bars = bars::Bars::new(self.bars, [left, right], self.scale);
        FiveBar::new(bars, self.couplers.tables())
    }
}

/// Steps in a millimetre.
pub fn per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

pub(super) fn steps(mm: f64, scale: Scale) -> i32 {
    (mm * per_mm(scale)).round() as i32
}
