//! Points and directions of the plane.

use core::ops::{Add, Mul, Neg, Sub};

use crate::angle::{atan2, sin_cos};

/// A point or a displacement in mm, or a direction of length one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector {
    /// To the right.
    pub x: f64,
    /// Forward.
    pub y: f64,
}

impl Vector {
    /// The vector with these two components.
    #[inline]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The direction (length one) at an angle in degrees.
    #[inline]
    pub fn direction(degrees: f64) -> Self {
        let (sin, cos) = sin_cos(degrees);
        Self::new(cos, sin)
    }

    /// The angle of this vector in (-180, 180] degrees; 0 for the zero vector.
    #[inline]
    pub fn angle(self) -> f64 {
        atan2(self.y, self.x)
    }

    /// Length in the unit of the components.
    #[inline]
    pub fn length(self) -> f64 {
        libm::sqrt(self.square())
    }

    /// Length squared.
    #[inline]
    pub fn square(self) -> f64 {
        self.dot(self)
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// Cross product: |self| |other| sin of the angle from self to other.
    #[inline]
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// Turned by +90 degrees, exactly.
    #[inline]
    pub const fn left(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Turned by -90 degrees, exactly.
    #[inline]
    pub const fn right(self) -> Self {
        Self::new(self.y, -self.x)
    }

    /// The mirror image in the x axis: angles change sign.
    #[inline]
    pub const fn mirrored(self) -> Self {
        Self::new(self.x, -self.y)
    }

    /// True if neither component is infinite or NaN.
    #[inline]
    pub const fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Add for Vector {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Vector {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl Neg for Vector {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}
