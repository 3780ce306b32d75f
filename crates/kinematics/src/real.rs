//! A number, or several at once.
//!
//! The closed forms are written once, for any [`Real`]: a pose takes an f64, a
//! batch of poses takes [`Lanes`], whose operations the compiler turns into
//! vector instructions. Every lane has the bits that the pose alone would have.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::angle::{atan2_all, sin_cos_all};

/// What the closed forms ask of a number.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant.
    fn of(value: f64) -> Self;
    /// Square root, rounded correctly; of a negative number it is 0.
    fn root(self) -> Self;
    /// Sines and cosines of angles in degrees.
    fn sin_cos_each<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]);
    /// Angles of vectors in (-180, 180] degrees.
    fn atan2_each<const K: usize>(y: [Self; K], x: [Self; K]) -> [Self; K];
}

impl Real for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn root(self) -> Self {
        // Not `max`, which would turn what is no number into 0.
        (if self < 0.0 { 0.0 } else { self }).sqrt()
    }

    #[inline(always)]
    fn sin_cos_each<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        sin_cos_all(degrees)
    }

    #[inline(always)]
    fn atan2_each<const K: usize>(y: [Self; K], x: [Self; K]) -> [Self; K] {
        atan2_all(y, x)
    }
}

/// Several numbers that take the same steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn zip(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self.0;
        for (value, other) in result.iter_mut().zip(other.0) {
            *value = of(*value, other);
        }
        Self(result)
    }

    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        let mut result = self.0;
        for value in &mut result {
            *value = of(*value);
        }
        Self(result)
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<const N: usize> Mul<f64> for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.each(|a| a * factor)
    }
}

impl<const N: usize> Div for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl<const N: usize> Real for Lanes<N> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([value; N])
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.each(Real::root)
    }

    #[inline(always)]
    fn sin_cos_each<const K: usize>(degrees: [Self; K]) -> ([Self; K], [Self; K]) {
        let (mut sines, mut cosines) = (degrees, degrees);
        for i in 0..K {
            (sines[i].0, cosines[i].0) = sin_cos_all(degrees[i].0);
        }
        (sines, cosines)
    }

    #[inline(always)]
    fn atan2_each<const K: usize>(y: [Self; K], x: [Self; K]) -> [Self; K] {
        let mut degrees = y;
        for i in 0..K {
            degrees[i].0 = atan2_all(y[i].0, x[i].0);
        }
        degrees
    }
}
