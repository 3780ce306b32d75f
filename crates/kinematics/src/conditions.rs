//! The value of every condition of a safe pose, which [`crate::Limits`] judges.

use crate::end::End;
use crate::five_bar::FiveBarPose;
use crate::leg;
use crate::lizard::Solution;
use crate::margins::Check;
use crate::real::Real;

impl Solution {
    /// The value of every condition of a safe pose: margins, strokes, and the distance of
    /// the crank tips from crossing.
    pub fn conditions(&self) -> impl Iterator<Item = (Check, f64)> + use<> {
        self.margins
            .iter()
            .chain(core::iter::zip(Check::STROKE, [self.left.s, self.right.s]))
            .chain(core::iter::zip(
                Check::UNCROSSED,
                [self.head.gap.x, self.tail.gap.x],
            ))
    }
}

impl<T: Real> FiveBarPose<T> {
    /// The value of every condition of a safe pose that depends on this end alone: the
    /// type-2 margin, the type-1 and leg margins, the left crank's first, and the distance
    /// of the crank tips from crossing.
    pub fn conditions(&self, end: End) -> [(Check, T); 6] {
        let check_of_end = |[head, tail]: [Check; 2]| match end {
            End::Head => head,
            End::Tail => tail,
        };
        let [arm_left, arm_right] = end.pick(Check::TYPE1);
        let [leg_left, leg_right] = end.pick(Check::LEG);
        [
            (check_of_end(Check::TYPE2), self.type2),
            (arm_left, self.type1_left()),
            (arm_right, self.type1_right()),
            (leg_left, leg::margin(self.left_crank)),
            (leg_right, leg::margin(self.right_crank)),
            (check_of_end(Check::UNCROSSED), self.gap.x),
        ]
    }
}
