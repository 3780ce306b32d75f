//! The number types of the closed forms: a single f64, or several in parallel.
//!
//! The closed forms are written once, for any [`Real`]. A single pose uses f64; a batch of five-bars or sliders uses
//! [`Lanes`], whose operations the compiler can vectorise. Each lane is bit-identical to the result with a single f64.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::angle::sin_cos_all;

/// A number, or a vector of numbers, for which the closed forms can be computed.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Converts a constant to this type of number.
    fn constant(value: f64) -> Self;
    /// The correctly rounded square root; 0 for a negative number, NaN for NaN.
    fn sqrt_or_zero(self) -> Self;
    /// Sines and cosines of angles in degrees.
    fn sin_cos_all<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]);
}

impl Real for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt_or_zero(self) -> Self {
        // `max` would turn NaN into 0.
        (if self < 0.0 { 0.0 } else { self }).sqrt()
    }

    #[inline(always)]
    fn sin_cos_all<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        sin_cos_all(degrees)
    }
}

/// A vector of numbers, one per lane; every operation acts lane by lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn combine_lanes(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self.0;
        for (value, other) in result.iter_mut().zip(other.0) {
            *value = operation(*value, other);
        }
        Self(result)
    }

    #[inline(always)]
    fn map_lanes(self, function: impl Fn(f64) -> f64) -> Self {
        let mut result = self.0;
        for value in &mut result {
            *value = function(*value);
        }
        Self(result)
    }
}

macro_rules! impl_lane_by_lane {
    ($($operator:ident $method:ident $symbol:tt)*) => {$(
        impl<const N: usize> $operator for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.combine_lanes(other, |a, b| a $symbol b)
            }
        }
    )*};
}

impl_lane_by_lane!(Add add + Sub sub - Mul mul * Div div /);

impl<const N: usize> Mul<f64> for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.map_lanes(|a| a * factor)
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map_lanes(|a| -a)
    }
}

impl<const N: usize> Real for Lanes<N> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; N])
    }

    #[inline(always)]
    fn sqrt_or_zero(self) -> Self {
        self.map_lanes(Real::sqrt_or_zero)
    }

    #[inline(always)]
    fn sin_cos_all<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        let (mut sines, mut cosines) = (degrees, degrees);
        for i in 0..K {
            (sines[i].0, cosines[i].0) = sin_cos_all(degrees[i].0);
        }
        (sines, cosines)
    }
}
