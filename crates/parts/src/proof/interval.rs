//! Interval arithmetic: numbers between two known bounds.
//!
//! Every result is rounded outward to the next f64, so the bounds also hold for the exact result. Existing crates
//! require the newest processors (inari, for its rounding modes) or have no sines, and cannot implement [`Real`].

use std::ops::{Add, Div, Mul, Neg, Sub};

use lizard_kinematics::{Real, sin_cos};

/// An upper bound of the error of a computed sine or cosine, which is at most 1.5 units in the last place.
const SINE_ERROR: f64 = 1e-15;

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// The interval of all numbers.
    const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Creates the interval between two numbers.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Largest absolute value in the interval.
    pub fn max_abs(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the intersection with another interval that contains the same number.
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// Rounds computed bounds outward. Returns all numbers if a bound is NaN.
    fn round_outward(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self::new(low.next_down(), high.next_up())
    }

    /// Bounds sine and cosine over all angles (deg) in the interval.
    fn sine_and_cosine(self) -> (Self, Self) {
        // True if the slightly widened interval contains `angle` plus any number of full turns.
        let contains_angle = |angle: f64| {
            let turns = ((self.low - angle) / 360.0 - 1e-9).ceil();
            turns * 360.0 + angle <= self.high + 1e-6
        };
        let (sin_a, cos_a) = sin_cos(self.low);
        let (sin_b, cos_b) = sin_cos(self.high);
        let bounds_between = |a: f64, b: f64, top_deg: f64, bottom_deg: f64| {
            let (mut low, mut high) = (a.min(b) - SINE_ERROR, a.max(b) + SINE_ERROR);
            if contains_angle(bottom_deg) {
                low = -1.0;
            }
            if contains_angle(top_deg) {
                high = 1.0;
            }
            Self::new(low, high)
        };
        let sine = bounds_between(sin_a, sin_b, 90.0, -90.0);
        (sine, bounds_between(cos_a, cos_b, 0.0, 180.0))
    }
}

/// Implements operators, each written as `Operator method(self, other: Type) { result }`.
macro_rules! operators {
    ($($operator:ident $method:ident($self:ident, $other:ident: $type:ty) $result:block)*) => {$(
        impl $operator<$type> for Interval {
            type Output = Self;
            fn $method($self, $other: $type) -> Self $result
        }
    )*};
}

operators! {
    Add add(self, other: Self) { Self::round_outward(self.low + other.low, self.high + other.high) }
    Sub sub(self, other: Self) { self + -other }
    Mul mul(self, other: Self) {
        let [a, b] = [other.low, other.high].map(|factor| self.low * factor);
        let [c, d] = [other.low, other.high].map(|factor| self.high * factor);
        // 0 times infinity is NaN, which min and max would hide.
        if (a + b + c + d).is_nan() {
            return Self::ALL;
        }
        Self::round_outward(a.min(b).min(c).min(d), a.max(b).max(c).max(d))
    }
    Mul mul(self, factor: f64) {
        let (a, b) = (self.low * factor, self.high * factor);
        Self::round_outward(a.min(b), a.max(b))
    }
    // A quotient is a product with the reciprocal, which is itself rounded outward.
    Div div(self, other: Self) {
        if other.low <= 0.0 && other.high >= 0.0 {
            return Self::ALL;
        }
        self * Self::round_outward(1.0 / other.high, 1.0 / other.low)
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Real for Interval {
    fn constant(value: f64) -> Self {
        Self::new(value, value)
    }

    fn sqrt_or_zero(self) -> Self {
        let clamped_root = |value: f64| value.max(0.0).sqrt();
        let Self { low, high } =
            Self::round_outward(clamped_root(self.low), clamped_root(self.high));
        Self::new(low.max(0.0), high)
    }

    fn sin_cos_all<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        let sines_and_cosines = degrees.map(Self::sine_and_cosine);
        (
            sines_and_cosines.map(|(sine, _)| sine),
            sines_and_cosines.map(|(_, cosine)| cosine),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contains(interval: Interval, value: f64) -> bool {
        interval.low <= value && value <= interval.high
    }

    #[test]
    fn an_interval_contains_the_results_for_all_numbers_in_its_operands() {
        let mut random = 1_u64;
        let mut next_random = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 11) as f64 / (1_u64 << 53) as f64 * 8.0 - 4.0
        };
        for _ in 0..20_000 {
            let [a, b, c, d] = [next_random(), next_random(), next_random(), next_random()];
            let x = Interval::new(a.min(b), a.max(b));
            let y = Interval::new(c.min(d), c.max(d));
            for fraction in [0.0, 0.3, 1.0] {
                let value_at =
                    |interval: Interval| interval.low + fraction * (interval.high - interval.low);
                let [p, q] =
                    [x, y].map(|interval| value_at(interval).clamp(interval.low, interval.high));
                assert!(contains(x + y, p + q) && contains(x - y, p - q) && contains(-x, -p));
                assert!(contains(x * y, p * q) && contains(x * c, p * c));
                assert!(q == 0.0 || contains(x / y, p / q), "{x:?} / {y:?}");
                assert!(contains(x.sqrt_or_zero(), p.max(0.0).sqrt()));
                let degrees = Interval::new(x.low * 100.0, x.high * 100.0);
                let ([sine], [cosine]) = Interval::sin_cos_all([degrees]);
                let (sin, cos) = (p * 100.0).to_radians().sin_cos();
                let widen = |i: Interval| Interval::new(i.low - 1e-14, i.high + 1e-14);
                assert!(contains(widen(sine), sin) && contains(widen(cosine), cos));
            }
        }
    }

    #[test]
    fn a_result_is_as_narrow_as_the_exact_range_except_for_rounding() {
        let is_near = |interval: Interval, low: f64, high: f64| {
            (interval.low - low).abs() < 1e-14 && (interval.high - high).abs() < 1e-14
        };
        let (x, y) = (Interval::new(-1.0, 2.0), Interval::new(3.0, 5.0));
        assert!(is_near(x + y, 2.0, 7.0) && is_near(x - y, -6.0, -1.0));
        assert!(is_near(x * y, -5.0, 10.0) && is_near(x / y, -1.0 / 3.0, 2.0 / 3.0));
        assert!(is_near(y.sqrt_or_zero(), 3.0_f64.sqrt(), 5.0_f64.sqrt()));
        let ([sine], [cosine]) = Interval::sin_cos_all([Interval::new(30.0, 120.0)]);
        assert!(is_near(sine, 0.5, 1.0) && is_near(cosine, -0.5, 0.75_f64.sqrt()));
        let ([sine], [cosine]) = Interval::sin_cos_all([Interval::new(-450.0, -340.0)]);
        assert!(is_near(sine, -1.0, 20.0_f64.to_radians().sin()) && is_near(cosine, 0.0, 1.0));
    }

    #[test]
    fn a_quotient_by_an_interval_that_contains_0_is_unbounded() {
        let quotient = Interval::constant(1.0) / Interval::new(-1.0, 2.0);
        assert_eq!(quotient, Interval::ALL);
        assert_eq!(quotient * Interval::constant(0.0), Interval::ALL);
        assert_eq!(quotient - quotient, Interval::ALL);
    }
}
