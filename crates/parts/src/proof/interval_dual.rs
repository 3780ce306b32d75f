//! Forward-mode automatic differentiation with bounds: dual numbers whose value and derivatives are intervals.
//!
//! The closed-form equations of the mechanism accept any number type ([`Real`]), and therefore also this one. Each
//! result includes its derivatives with respect to the servos' angles. No derivative is worked out by hand.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

use lizard_kinematics::Real;

use super::interval::Interval;

/// Bounds of a number and of its derivatives while `N` servos turn within given ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalDual<const N: usize> {
    /// Bounds of the number.
    pub value: Interval,
    /// Bounds of the number's derivatives with respect to the servos' angles, per degree.
    pub derivatives: [Interval; N],
}

impl<const N: usize> IntervalDual<N> {
    /// Creates the angle of one of the servos, deg.
    pub fn angle(servo: usize, bounds: Interval) -> Self {
        let mut angle = Self::constant(0.0);
        (angle.value, angle.derivatives[servo]) = (bounds, Interval::constant(1.0));
        angle
    }

    /// Largest change of the number from its value at the middle angles while each servo stays within its half width
    /// (deg) of its middle angle.
    pub fn max_change(&self, half_widths: &[f64; N]) -> f64 {
        let slopes = self.derivatives.iter().zip(half_widths);
        slopes.fold(0.0, |sum, (slope, half_width)| {
            sum + slope.max_abs() * half_width
        })
    }

    /// Tightens the bounds with the value at the middle angles and the largest change from this value. Bounds from
    /// interval arithmetic are often much wider, because each operation treats its operands as independent.
    pub fn tighten(self, middle: f64, half_widths: &[f64; N]) -> Self {
        /// Upper bound of the rounding error of `middle`.
        const ROUNDING: f64 = 1e-9;
        let change = self.max_change(half_widths) + ROUNDING;
        let (low, high) = (middle - change, middle + change);
        if low.is_nan() || high.is_nan() {
            return self;
        }
        Self {
            value: self.value.intersection(Interval::new(low, high)),
            ..self
        }
    }

    /// Returns f(self), given its value and the rule that turns a derivative of `self` into one of f(self).
    fn map_chain_rule(self, value: Interval, rule: impl Fn(Interval) -> Interval) -> Self {
        Self {
            value,
            derivatives: self.derivatives.map(rule),
        }
    }

    /// Returns f(self, other), given its value and the rule that turns two derivatives into one of f(self, other).
    fn zip_chain_rule(
        self,
        other: Self,
        value: Interval,
        rule: impl Fn(Interval, Interval) -> Interval,
    ) -> Self {
        let derivatives = std::array::from_fn(|i| rule(self.derivatives[i], other.derivatives[i]));
        Self { value, derivatives }
    }
}

/// Implements operators. `map_chain_rule` and `zip_chain_rule` apply the chain rule.
macro_rules! operators {
    ($($operator:ident $method:ident($self:ident, $other:ident: $type:ty) $result:block)*) => {$(
        // The derivatives of a product or a quotient also use other operators.
        #[allow(clippy::suspicious_arithmetic_impl)]
        impl<const N: usize> $operator<$type> for IntervalDual<N> {
            type Output = Self;
            fn $method($self, $other: $type) -> Self $result
        }
    )*};
}

operators! {
    Add add(self, other: Self) { self.zip_chain_rule(other, self.value + other.value, |a, b| a + b) }
    Sub sub(self, other: Self) { self.zip_chain_rule(other, self.value - other.value, |a, b| a - b) }
    Mul mul(self, other: Self) {
        let (product, own_value) = (self.value * other.value, self.value);
        self.zip_chain_rule(other, product, |a, b| a * other.value + b * own_value)
    }
    Mul mul(self, factor: f64) { self.map_chain_rule(self.value * factor, |slope| slope * factor) }
    Div div(self, other: Self) {
        let quotient = self.value / other.value;
        self.zip_chain_rule(other, quotient, |a, b| (a - quotient * b) / other.value)
    }
}

impl<const N: usize> Neg for IntervalDual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map_chain_rule(-self.value, |slope| -slope)
    }
}

impl<const N: usize> Real for IntervalDual<N> {
    fn constant(value: f64) -> Self {
        Self {
            value: Interval::constant(value),
            derivatives: [Interval::constant(0.0); N],
        }
    }

    fn sqrt_or_zero(self) -> Self {
        let root = self.value.sqrt_or_zero();
        self.map_chain_rule(root, |slope| slope / (root * 2.0))
    }

    fn sin_cos_all<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        let (sines, cosines) = Interval::sin_cos_all(degrees.map(|angle| angle.value));
        // One degree in radians, between the neighbouring floating-point numbers.
        let radians_per_degree = Interval::new((PI / 180.0).next_down(), (PI / 180.0).next_up());
        let (mut sin, mut cos) = (degrees, degrees);
        for i in 0..K {
            let in_radians = |slope: Interval| slope * radians_per_degree;
            sin[i] = degrees[i].map_chain_rule(sines[i], |slope| in_radians(slope) * cosines[i]);
            cos[i] = degrees[i].map_chain_rule(cosines[i], |slope| -in_radians(slope) * sines[i]);
        }
        (sin, cos)
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::{AssemblyMode, FiveBar, Vector};

    use super::*;

    const HEAD: FiveBar = FiveBar::new([20.0, 30.0, 50.0, 45.0, 28.0]);

    /// Computes the coordinates of a five-bar's end point, and its type-2 margin, at two crank angles.
    fn compute_point_and_margin<T: Real>([left, right]: [T; 2]) -> [T; 3] {
        let (sin, cos) = T::sin_cos_all([left, right]);
        let [left, right] = [0, 1].map(|i| Vector::new(cos[i], sin[i]));
        let pose = HEAD.pose_unchecked(AssemblyMode::Ahead, left, right);
        [pose.end_point.x, pose.end_point.y, pose.type2]
    }

    #[test]
    fn bounds_of_a_linkage_contain_its_positions_and_derivatives() {
        for (left, right) in [(120.0, 60.0), (95.0, 40.0), (140.0, 80.0)] {
            for half_width in [0.01, 0.1, 1.0] {
                let bounds_around =
                    |middle: f64| Interval::new(middle - half_width, middle + half_width);
                let angles = [(0, left), (1, right)];
                let duals = compute_point_and_margin(
                    angles.map(|(i, angle)| IntervalDual::<2>::angle(i, bounds_around(angle))),
                );
                let middle = compute_point_and_margin([left, right]);
                for (x, y) in [(-1.0, 1.0), (0.5, 0.5), (1.0, -1.0), (-0.2, -1.0)] {
                    let crank_angles = [left + x * half_width, right + y * half_width];
                    let step_deg = 1e-5;
                    let values = compute_point_and_margin(crank_angles);
                    for (i, value) in values.into_iter().enumerate() {
                        let IntervalDual { value: bounds, .. } = duals[i];
                        assert!(bounds.low <= value && value <= bounds.high);
                        let change = duals[i].max_change(&[half_width; 2]);
                        assert!((value - middle[i]).abs() <= change + 1e-12);
                        for servo in 0..2 {
                            let mut next_angles = crank_angles;
                            next_angles[servo] += step_deg;
                            let derivative =
                                (compute_point_and_margin(next_angles)[i] - value) / step_deg;
                            let Interval { low, high } = duals[i].derivatives[servo];
                            assert!(low - 1e-4 <= derivative && derivative <= high + 1e-4);
                            // The bounds of the derivatives are not much wider than needed.
                            assert!(half_width > 0.1 || high - low < 0.1, "{low} {high}");
                        }
                    }
                }
            }
        }
    }
}
