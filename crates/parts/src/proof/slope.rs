//! Numbers that depend on some servos: bounds, and bounds of how fast they change.
//!
//! The closed forms of the mechanism take any number ([`Real`]), so they also take these,
//! and each result says how it depends on the servos. No derivative is derived by hand.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

use lizard_kinematics::Real;

use super::interval::Interval;

/// Bounds of a number, and of its derivatives, while `N` servos turn within bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<const N: usize> {
    /// Bounds of its value.
    pub value: Interval,
    /// Bounds of its derivatives by the servos' angles, per degree.
    pub slope: [Interval; N],
}

impl<const N: usize> Slope<N> {
    /// The angle of one of the servos, deg.
    pub fn angle(servo: usize, bounds: Interval) -> Self {
        let mut slope = [Interval::of(0.0); N];
        slope[servo] = Interval::of(1.0);
        Self {
            value: bounds,
            slope,
        }
    }

    /// Largest distance from its value at the middle angles, if each servo may be `half`
    /// degrees from there.
    pub fn strays(&self, half: &[f64; N]) -> f64 {
        let slopes = self.slope.iter().zip(half);
        slopes.fold(0.0, |sum, (slope, half)| sum + slope.most() * half)
    }

    /// The same number, its bounds tightened by its value in the middle and the distance it
    /// can stray. Bounds from operations are often much wider, because each operation takes
    /// its operands to be independent.
    pub fn near(self, middle: f64, half: &[f64; N]) -> Self {
        /// A bound of the rounding error of `middle`.
        const ROUNDING: f64 = 1e-9;
        let strays = self.strays(half) + ROUNDING;
        let (low, high) = (middle - strays, middle + strays);
        if low.is_nan() || high.is_nan() {
            return self;
        }
        Self {
            value: self.value.and(Interval::new(low, high)),
            ..self
        }
    }

    fn each(self, value: Interval, of: impl Fn(Interval) -> Interval) -> Self {
        Self {
            value,
            slope: self.slope.map(of),
        }
    }

    fn zip(
        self,
        other: Self,
        value: Interval,
        of: impl Fn(Interval, Interval) -> Interval,
    ) -> Self {
        let mut slope = self.slope;
        for (a, b) in slope.iter_mut().zip(other.slope) {
            *a = of(*a, b);
        }
        Self { value, slope }
    }
}

impl<const N: usize> Add for Slope<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Slope<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl<const N: usize> Neg for Slope<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.each(-self.value, |slope| -slope)
    }
}

impl<const N: usize> Mul for Slope<N> {
    type Output = Self;
    // The rule for the slopes has other operations in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| {
            a * other.value + b * self.value
        })
    }
}

impl<const N: usize> Mul<f64> for Slope<N> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.each(self.value * factor, |slope| slope * factor)
    }
}

impl<const N: usize> Div for Slope<N> {
    type Output = Self;
    // The rule for the slopes has other operations in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.zip(other, quotient, |a, b| (a - quotient * b) / other.value)
    }
}

impl<const N: usize> Real for Slope<N> {
    fn of(value: f64) -> Self {
        Self {
            value: Interval::of(value),
            slope: [Interval::of(0.0); N],
        }
    }

    fn root(self) -> Self {
        let root = self.value.root();
        self.each(root, |slope| slope / (root * 2.0))
    }

    fn sin_cos_each<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        let (sines, cosines) = Interval::sin_cos_each(degrees.map(|angle| angle.value));
        // The degree in radians, and a number beyond it.
        let degree = Interval::new((PI / 180.0).next_down(), (PI / 180.0).next_up());
        let (mut sin, mut cos) = (degrees, degrees);
        for i in 0..K {
            let turn = |slope: Interval| slope * degree;
            sin[i] = degrees[i].each(sines[i], |slope| turn(slope) * cosines[i]);
            cos[i] = degrees[i].each(cosines[i], |slope| -turn(slope) * sines[i]);
        }
        (sin, cos)
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::{AssemblyMode, FiveBar, Vector};

    use super::*;

    const HEAD: FiveBar = FiveBar {
        base: 20.0,
        crank_left: 30.0,
        coupler_left: 50.0,
        coupler_right: 45.0,
        crank_right: 28.0,
    };

    /// The end point and a margin.
    fn numbers<T: Real>([left, right]: [T; 2]) -> [T; 3] {
        let (sin, cos) = T::sin_cos_each([left, right]);
        let pose = HEAD.shape(
            AssemblyMode::Ahead,
            Vector::new(cos[0], sin[0]),
            Vector::new(cos[1], sin[1]),
        );
        [pose.end_point.x, pose.end_point.y, pose.type2]
    }

    #[test]
    fn a_linkage_on_bounds_holds_every_pose_between_them_and_its_rates() {
        for (left, right) in [(120.0, 60.0), (95.0, 40.0), (140.0, 80.0)] {
            for half in [0.01, 0.1, 1.0] {
                let bounds = |middle: f64| Interval::new(middle - half, middle + half);
                let held = numbers::<Slope<2>>([
                    Slope::angle(0, bounds(left)),
                    Slope::angle(1, bounds(right)),
                ]);
                let middle = numbers([left, right]);
                for (x, y) in [(-1.0, 1.0), (0.5, 0.5), (1.0, -1.0), (-0.2, -1.0)] {
                    let at = [left + x * half, right + y * half];
                    let step = 1e-5;
                    for (i, value) in numbers(at).into_iter().enumerate() {
                        let Slope { value: bounds, .. } = held[i];
                        assert!(bounds.low <= value && value <= bounds.high);
                        let strays = held[i].strays(&[half; 2]);
                        assert!((value - middle[i]).abs() <= strays + 1e-12);
                        for servo in 0..2 {
                            let mut next = at;
                            next[servo] += step;
                            let rate = (numbers(next)[i] - value) / step;
                            let Interval { low, high } = held[i].slope[servo];
                            assert!(low - 1e-4 <= rate && rate <= high + 1e-4);
                            // And not much more than that.
                            assert!(half > 0.1 || high - low < 0.1, "{low} {high}");
                        }
                    }
                }
            }
        }
    }
}
