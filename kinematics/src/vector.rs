//! Points and directions of the plane.

use core::ops::{Add, Mul, Neg, Sub};

use crate::angle::sin_cos;

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
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The direction (length one) at an angle in degrees.
    pub fn direction(degrees: f64) -> Self {
        let (sin, cos) = sin_cos(degrees);
        Self::new(cos, sin)
    }

    /// The angle of this vector in (-180, 180] degrees; 0 for the zero vector.
    pub fn angle(self) -> f64 {
        let degrees = libm::atan2(self.y, self.x) * (180.0 / core::f64::consts::PI);
        // atan2 tells -0 from +0; the two are one direction.
        if degrees == -180.0 { 180.0 } else { degrees }
    }

    /// Length in the unit of the components.
    pub fn length(self) -> f64 {
        libm::sqrt(self.square())
    }

    /// Length squared.
    pub fn square(self) -> f64 {
        self.dot(self)
    }

    /// Scalar product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// Cross product: |self| |other| sin of the angle from self to other.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// Turned by +90 degrees, exactly.
    pub const fn left(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Turned by -90 degrees, exactly.
    pub const fn right(self) -> Self {
        Self::new(self.y, -self.x)
    }

    /// The mirror image in the x axis: angles change sign.
    pub const fn mirrored(self) -> Self {
        Self::new(self.x, -self.y)
    }

    /// True if neither component is infinite or NaN.
    pub const fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}
