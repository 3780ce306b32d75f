//! Points, displacements and directions in the plane.

use core::ops::{Add, Mul, Neg, Sub};

use crate::angle::{atan2, sin_cos};
use crate::real::Real;

/// A point or a displacement in mm, or a unit vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector<T = f64> {
    /// Component along the frame's x axis, to the robot's right.
    pub x: T,
    /// Component along the frame's y axis, forward or (in the tail's frame) backward.
    pub y: T,
}

impl<T> Vector<T> {
    /// Creates a vector from its two components.
    #[inline(always)]
    pub const fn new(x: T, y: T) -> Self {
        Self { x, y }
    }
}

impl Vector {
    /// The unit vector at an angle in degrees.
    #[inline]
    pub fn from_angle(degrees: f64) -> Self {
        let (sin, cos) = sin_cos(degrees);
        Self::new(cos, sin)
    }

    /// The angle of this vector in (-180, 180] degrees; 0 for the zero vector.
    #[inline]
    pub fn angle(self) -> f64 {
        atan2(self.y, self.x)
    }

    /// True if neither component is infinite or NaN.
    #[inline]
    pub const fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl<T: Real> Vector<T> {
    /// The vector's length, in the unit of its components.
    #[inline(always)]
    pub fn length(self) -> T {
        self.length_squared().sqrt_or_zero()
    }

    /// The square of the vector's length.
    #[inline(always)]
    pub fn length_squared(self) -> T {
        self.dot(self)
    }

    /// The scalar product with another vector.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y
    }

    /// The cross product: the product of both lengths and the sine of the angle from `self` to `other`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> T {
        self.x * other.y - self.y * other.x
    }

    /// The vector rotated by +90 degrees; exact.
    #[inline(always)]
    pub fn rotated_left(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// The vector rotated by -90 degrees; exact.
    #[inline(always)]
    pub fn rotated_right(self) -> Self {
        Self::new(self.y, -self.x)
    }

    /// The mirror image in the x axis, whose angle has the opposite sign.
    #[inline(always)]
    pub fn mirrored_in_x_axis(self) -> Self {
        Self::new(self.x, -self.y)
    }

    /// The vector multiplied by a factor of its own number type; [`Mul`] multiplies by an f64.
    #[inline(always)]
    pub fn scaled(self, factor: T) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }

    /// Converts a constant vector to this type of number.
    #[inline(always)]
    pub fn constant(vector: Vector) -> Self {
        Self::new(T::constant(vector.x), T::constant(vector.y))
    }
}

impl<T: Real> Add for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl<T: Real> Sub for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl<T: Real> Mul<f64> for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl<T: Real> Neg for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}
