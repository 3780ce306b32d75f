//! Rates and accelerations of the passive joints from those of the servos.
//!
//! The paper announces an acceleration analysis but does not contain one. The differentiated loop
//! equations are linear in the unknown rates and in the unknown accelerations, both with the matrix
//! K* (see `constraints.rs`). Projecting the equation of a five-bar onto a coupler eliminates this
//! coupler's own unknown, so the 2x2 system needs only two divisions by sin(theta3 - theta2).

use crate::end::End;
use crate::five_bar::FiveBarPose;
use crate::lizard::Solution;
use crate::side::Side;
use crate::slider::SliderPose;
use crate::vector::Vector;

/// The rates and accelerations of the four servos, in servo order A1, A2, A3, A4, chassis frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoMotion {
    /// Rates of the servos, deg/s.
    pub rates: [f64; 4],
    /// Accelerations of the servos, deg/s^2.
    pub accelerations: [f64; 4],
}

/// The first and second time derivatives of a quantity in degrees or mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Derivative<T> {
    /// Per second: deg/s or mm/s.
    pub rate: T,
    /// Per second squared: deg/s^2 or mm/s^2.
    pub acceleration: T,
}

/// The rates and accelerations of the passive joints and of the end points, chassis frame. The legs are omitted,
/// because they turn with their servos.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Derivatives {
    /// Head, left coupler; degrees.
    pub theta2: Derivative<f64>,
    /// Head, right coupler; degrees.
    pub theta3: Derivative<f64>,
    /// Tail, left coupler; degrees.
    pub theta6: Derivative<f64>,
    /// Tail, right coupler; degrees.
    pub theta7: Derivative<f64>,
    /// The head point, mm.
    pub head: Derivative<Vector>,
    /// The tail point, mm.
    pub tail: Derivative<Vector>,
    /// Direction of the left slider; degrees.
    pub phi_left: Derivative<f64>,
    /// Travel of the left slider; mm.
    pub s_left: Derivative<f64>,
    /// Direction of the right slider; degrees.
    pub phi_right: Derivative<f64>,
    /// Travel of the right slider; mm.
    pub s_right: Derivative<f64>,
}

/// Angular rate and acceleration, rad/s and rad/s^2.
type Spin = Derivative<f64>;

impl Solution {
    /// The rates and accelerations of the passive joints and of the end points. Not finite at a type-2
    /// singularity, where the servos' rates do not determine them.
    pub fn derivatives(&self, motion: &ServoMotion) -> Derivatives {
        let spin = |servo: usize| Spin::new(motion.rates[servo], motion.accelerations[servo]);
        let spins = [0, 1, 2, 3].map(|servo| spin(servo).map(f64::to_radians));
        let derivatives_of_end = |end: End| {
            let apply_sign = |w: f64| end.sign() * w;
            let [left, right] = end.pick(spins).map(|spin| spin.map(apply_sign));
            let own = solve_loop_derivatives(self.end(end), left, right);
            LoopDerivatives {
                left_coupler: own.left_coupler.map(apply_sign).map(f64::to_degrees),
                right_coupler: own.right_coupler.map(apply_sign).map(f64::to_degrees),
                point: own.point.map(|v| end.mirror(v)),
            }
        };
        let (head, tail) = (derivatives_of_end(End::Head), derivatives_of_end(End::Tail));
        let derivatives_of_slider = |side: Side| {
            let ([front, rear], pose) = (side.pick(spins), self.side(side));
            let (phi, s) =
                compute_slider_derivatives(pose, (pose.rear_tip, rear), (pose.front_arm(), front));
            (phi.map(f64::to_degrees), s)
        };
        let (phi_left, s_left) = derivatives_of_slider(Side::Left);
        let (phi_right, s_right) = derivatives_of_slider(Side::Right);
        Derivatives {
            theta2: head.left_coupler,
            theta3: head.right_coupler,
            theta6: tail.left_coupler,
            theta7: tail.right_coupler,
            head: head.point,
            tail: tail.point,
            phi_left,
            s_left,
            phi_right,
            s_right,
        }
    }
}

impl<T> Derivative<T> {
    fn new(rate: T, acceleration: T) -> Self {
        Self { rate, acceleration }
    }

    /// Applies a function to the rate and to the acceleration; it must be linear, such as a coordinate of a vector.
    pub fn map<U>(self, f: impl Fn(T) -> U) -> Derivative<U> {
        Derivative::new(f(self.rate), f(self.acceleration))
    }
}

/// The rates and accelerations of a five-bar, in the end's own frame.
struct LoopDerivatives {
    /// The left coupler's rotation.
    left_coupler: Spin,
    /// The right coupler's rotation.
    right_coupler: Spin,
    /// The end point, mm.
    point: Derivative<Vector>,
}

/// Solves the first and second time derivatives of l1 u1 + l2 u2 = l0 + l4 u4 + l3 u3 for the couplers, where u1 to
/// u4 are the unit vectors of the links.
fn solve_loop_derivatives(
    pose: &FiveBarPose,
    crank_left: Spin,
    crank_right: Spin,
) -> LoopDerivatives {
    let r1 = pose.left_crank * pose.five_bar.left_crank_length;
    let r2 = pose.left_coupler * pose.five_bar.left_coupler_length;
    let r3 = pose.right_coupler * pose.five_bar.right_coupler_length;
    let r4 = pose.right_crank * pose.five_bar.right_crank_length;
    let (u2, u3) = (pose.left_coupler, pose.right_coupler);
    // The unknown rates x of theta2 and y of theta3 obey x rot(r2) - y rot(r3) = c, where rot turns a vector by +90
    // degrees. The dot product with u3 isolates x, that with u2 isolates y. The same holds for the accelerations.
    // Below, w is a rate (rad/s) and e an acceleration (rad/s^2), numbered like their links.
    let solve_couplers = |c: Vector| {
        (
            c.dot(u3) / (pose.five_bar.left_coupler_length * pose.type2),
            c.dot(u2) / (pose.five_bar.right_coupler_length * pose.type2),
        )
    };
    let (w1, w4) = (crank_left.rate, crank_right.rate);
    let (w2, w3) = solve_couplers(r4.rotated_left() * w4 - r1.rotated_left() * w1);
    let centripetal = r1 * (w1 * w1) + r2 * (w2 * w2) - r3 * (w3 * w3) - r4 * (w4 * w4);
    let (e1, e4) = (crank_left.acceleration, crank_right.acceleration);
    let (e2, e3) = solve_couplers(centripetal + r4.rotated_left() * e4 - r1.rotated_left() * e1);
    LoopDerivatives {
        left_coupler: Spin::new(w2, e2),
        right_coupler: Spin::new(w3, e3),
        point: Derivative {
            rate: r1.rotated_left() * w1 + r2.rotated_left() * w2,
            acceleration: tip_acceleration(r1, crank_left) + r2.rotated_left() * e2
                - r2 * (w2 * w2),
        },
    }
}

/// The acceleration of a link's tip relative to its other end.
fn tip_acceleration(link: Vector, spin: Spin) -> Vector {
    link.rotated_left() * spin.acceleration - link * (spin.rate * spin.rate)
}

/// Computes the rates and accelerations of a slider's direction (rad) and length (mm) from its arms' motion.
fn compute_slider_derivatives(
    pose: &SliderPose,
    (rear, rear_spin): (Vector, Spin),
    (front, front_spin): (Vector, Spin),
) -> (Spin, Derivative<f64>) {
    let slider_direction = pose.span * (1.0 / pose.d);
    let v = front.rotated_left() * front_spin.rate - rear.rotated_left() * rear_spin.rate;
    let a = tip_acceleration(front, front_spin) - tip_acceleration(rear, rear_spin);
    let (travel_rate, turn_rate) = (v.dot(slider_direction), slider_direction.cross(v) / pose.d);
    let turn_acceleration = (slider_direction.cross(a) - 2.0 * travel_rate * turn_rate) / pose.d;
    let travel_acceleration = a.dot(slider_direction) + pose.d * turn_rate * turn_rate;
    (
        Spin::new(turn_rate, turn_acceleration),
        Derivative::new(travel_rate, travel_acceleration),
    )
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::lizard::{Lizard, Pose};
    use crate::reference::{any_solved_lizard, config_with_cases};
    use crate::wrap;

    /// Largest step of the central differences, s.
    const MAX_STEP: f64 = 1e-4;
    /// Approximate largest change of a passive quantity in a step, deg or mm.
    const MAX_STEP_CHANGE: f64 = 0.1;

    /// The values of all passive quantities: angles of couplers and sliders, coordinates of head and tail, travels
    /// of the sliders.
    fn passive_values(solution: &Solution) -> [f64; 12] {
        let (head, tail) = (solution.head_point(), solution.tail_point());
        [
            solution.theta2(),
            solution.theta3(),
            solution.theta6(),
            solution.theta7(),
            solution.left.phi(),
            solution.right.phi(),
            head.x,
            head.y,
            tail.x,
            tail.y,
            solution.left.s,
            solution.right.s,
        ]
    }

    /// The rates and the accelerations of all passive quantities, in the order of [`passive_values`].
    fn passive_derivatives(solution: &Solution, motion: &ServoMotion) -> ([f64; 12], [f64; 12]) {
        let derivatives = solution.derivatives(motion);
        let all_derivatives = [
            derivatives.theta2,
            derivatives.theta3,
            derivatives.theta6,
            derivatives.theta7,
            derivatives.phi_left,
            derivatives.phi_right,
            derivatives.head.map(|v| v.x),
            derivatives.head.map(|v| v.y),
            derivatives.tail.map(|v| v.x),
            derivatives.tail.map(|v| v.y),
            derivatives.s_left,
            derivatives.s_right,
        ];
        (
            all_derivatives.map(|derivative| derivative.rate),
            all_derivatives.map(|derivative| derivative.acceleration),
        )
    }

    /// Solves the robot's pose `t` seconds later, with constant servo accelerations.
    fn solve_after(
        robot: &Lizard,
        pose: [f64; 4],
        motion: &ServoMotion,
        t: f64,
    ) -> Option<Solution> {
        let mut later_pose = pose;
        for (i, angle) in later_pose.iter_mut().enumerate() {
            *angle += motion.rates[i] * t + motion.accelerations[i] * t * t / 2.0;
        }
        robot.solve(&Pose::from(later_pose)).ok()
    }

    /// Random rates up to 300 deg/s and accelerations up to 2000 deg/s^2.
    fn any_motion() -> impl Strategy<Value = ServoMotion> {
        let four_ranges = |max: f64| [-max..max, -max..max, -max..max, -max..max];
        (four_ranges(300.0), four_ranges(2000.0)).prop_map(|(rates, accelerations)| ServoMotion {
            rates,
            accelerations,
        })
    }

    proptest! {
        #![proptest_config(config_with_cases(2048))]

        #[test]
        fn rates_and_accelerations_equal_the_difference_quotients_of_positions(
            (robot, pose, solution) in any_solved_lizard(), motion in any_motion(),
        ) {
            // Near a singularity, higher derivatives are too large for any fixed step.
            prop_assume!(solution.margins.type2[0] > 0.3 && solution.margins.type2[1] > 0.3);
            prop_assume!(solution.head.gap.length() > 5.0 && solution.tail.gap.length() > 5.0);
            prop_assume!(solution.left.d > 20.0 && solution.right.d > 20.0);
            let (rates, accelerations) = passive_derivatives(&solution, &motion);
            let max_magnitude = |values: &[f64; 12]| values.iter().fold(1.0_f64, |max, v| max.max(v.abs()));
            let (max_rate, max_acceleration) = (max_magnitude(&rates), max_magnitude(&accelerations));
            let step = MAX_STEP.min(MAX_STEP_CHANGE / max_rate);
            // The errors of the five-point formulas are of fourth order in the step.
            let values_at = |steps: f64| solve_after(&robot, pose, &motion, steps * step).map(|s| passive_values(&s));
            let start_values = passive_values(&solution);
            let [Some(first), Some(before), Some(after), Some(last)] = [-2.0, -1.0, 1.0, 2.0].map(values_at) else {
                return Err(TestCaseError::fail("a loop does not close in a neighbouring pose"));
            };
            for i in 0..12 {
                let difference_from_start = |value: f64| {
                    if i < 6 { wrap(value - start_values[i]) } else { value - start_values[i] }
                };
                let [a, b, c, d] = [first[i], before[i], after[i], last[i]].map(difference_from_start);
                let rate = (a - 8.0 * b + 8.0 * c - d) / (12.0 * step);
                let acceleration = (16.0 * (b + c) - a - d) / (12.0 * step * step);
                prop_assert!((rate - rates[i]).abs() < 1e-6 * max_rate, "quantity {i}: rate {rate}, expected {}", rates[i]);
                prop_assert!(
                    (acceleration - accelerations[i]).abs() < 1e-6 * max_acceleration.max(100.0),
                    "quantity {i}: acceleration {acceleration}, expected {}", accelerations[i]
                );
            }
        }
    }
}
