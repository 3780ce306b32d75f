//! The values of a pose (margins, slider travels, distances of crank tips) that [`crate::Limits`] compares with the
//! robot's limits.

use core::iter::zip;

use crate::end::End;
use crate::five_bar::FiveBarPose;
use crate::leg;
use crate::lizard::Solution;
use crate::margins::Check;
use crate::real::Real;

impl Solution {
    /// The values for all conditions of a safe pose: margins, slider travels, and the distances of
    /// the crank tips from crossing.
    pub fn conditions(&self) -> impl Iterator<Item = (Check, f64)> + use<> {
        let travels = zip(Check::STROKE, [self.left.s, self.right.s]);
        let gaps = zip(Check::UNCROSSED, [self.head.gap.x, self.tail.gap.x]);
        self.margins.iter().chain(travels).chain(gaps)
    }
}

impl<T: Real> FiveBarPose<T> {
    /// The values for the conditions that depend only on this end: the type-2 margin, the type-1 margins, the leg
    /// margins, and the distance of the crank tips from crossing. In each pair the left crank's margin comes first.
    pub fn conditions(&self, end: End) -> [(Check, T); 6] {
        let pick_check = |[head, tail]: [Check; 2]| match end {
            End::Head => head,
            End::Tail => tail,
        };
        let [left_arm, right_arm] = end.pick(Check::TYPE1);
        let [left_leg, right_leg] = end.pick(Check::LEG);
        [
            (pick_check(Check::TYPE2), self.type2),
            (left_arm, self.type1_left()),
            (right_arm, self.type1_right()),
            (left_leg, leg::margin(self.left_crank)),
            (right_leg, leg::margin(self.right_crank)),
            (pick_check(Check::UNCROSSED), self.gap.x),
        ]
    }
}
