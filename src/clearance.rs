//! The singularity guard: how clear of every hazard a pose is.
//!
//! No frame reaches a servo before it has passed here, be it from a gait, a
//! blend or a pose that somebody typed. The decision is a point test for any
//! pose within the servos' travel, not a box, and holds for head and tail
//! alike: in tail-local angles the tail is the head.
//!
//! Against the floating-point reference, the decision may differ only within
//! .002 of a margin's limit and 0.05 mm of the stroke's ends; a test walks the
//! whole square of crank angles to see that.

use crate::hazard::{Check, Hazard, Kind};
use crate::pose::Pose;
use crate::robot::{HEAD, LEFT, LIMITS, RIGHT, TAIL};
use crate::slider::Slider;
use crate::trig::Direction;

/// The smallest margins allowed, Q15.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Between the couplers of head and tail.
    pub type2: i16,
    /// Between each crank and its coupler.
    pub type1: i16,
    /// Of each parallelogram leg.
    pub leg: i16,
}

/// Every margin of one pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clearance {
    /// Q15, in the order of [`Check`]. A leg's margin is |sin theta_lg|, and
    /// negative beyond a change point (0, 180 deg), where the parallelogram
    /// may have come out crossed.
    pub margins: [i16; Check::MARGINS],
    /// The sliders' squared lengths, left and right, 1/65536 mm^2.
    pub sliders_sq: [u32; 2],
}

const SLIDERS: [Slider; 2] = [LEFT, RIGHT.mirrored()];
const STROKES_SQ: [[u32; 2]; 2] = [LEFT.stroke_sq(), RIGHT.stroke_sq()];

impl Clearance {
    /// Measures a pose.
    pub fn of(pose: &Pose) -> Self {
        let [a1, a2, a3, a4] = [0, 1, 2, 3].map(|servo| Direction::of(pose.angle(servo)));
        let (rear_right, rear_left) = (a3.tail_local(), a4.tail_local());
        let [head, at_a1, at_a2] = HEAD.margins(a1, a2);
        let [tail, at_a4, at_a3] = TAIL.margins(rear_left, rear_right);
        let [left, right] = &SLIDERS;
        Self {
            margins: [
                head,
                tail,
                at_a1,
                at_a2,
                at_a3,
                at_a4, //
                a1.sin,
                a2.sin,
                rear_right.sin,
                rear_left.sin,
            ],
            sliders_sq: [
                left.length_sq(a1, rear_left),
                right.length_sq(a2.mirrored(), rear_right.mirrored()),
            ],
        }
    }

    /// The smallest of the ten margins, Q15.
    pub fn smallest(&self) -> i16 {
        let mut least = i16::MAX;
        for margin in &self.margins {
            least = least.min(*margin);
        }
        least
    }

    /// The first limit that this pose breaks, singularities before strokes.
    pub fn hazard(&self) -> Option<Hazard> {
        for (place, value) in (0..).zip(&self.margins) {
            let check = Check::at(place);
            if *value < LIMITS.least(check.kind()) {
                return Some(Hazard {
                    check,
                    value: *value,
                });
            }
        }
        for (place, slider) in (0..).zip(&SLIDERS) {
            let length_sq = self.sliders_sq[place];
            let [min_sq, max_sq] = STROKES_SQ[place];
            if length_sq < min_sq || max_sq < length_sq {
                let check = Check::at((Check::MARGINS + place) as u8);
                return Some(Hazard {
                    check,
                    value: slider.travel(length_sq),
                });
            }
        }
        None
    }
}

impl Limits {
    /// The least margin of a kind.
    pub const fn least(&self, kind: Kind) -> i16 {
        match kind {
            Kind::Type2 => self.type2,
            Kind::Type1 => self.type1,
            Kind::Leg | Kind::Stroke => self.leg,
        }
    }
}
