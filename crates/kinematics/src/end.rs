//! The two ends of the robot, head and tail, each a five-bar and the point that it carries.
//!
//! The tail's mechanism is the head's, mirrored in the chassis frame's x axis. Each end has its own
//! frame: x to the robot's right, y away from the chassis, origin in the middle of the end's base. In
//! this frame one closed form solves both ends. Only this module knows how the ends differ.

use core::fmt;

use crate::angle::wrap;
use crate::real::Real;
use crate::vector::Vector;

/// One end of the robot: a five-bar and the point that it carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The front end, between A1 and A2.
    Head,
    /// The rear end, between A4 and A3.
    Tail,
}

impl End {
    /// Both ends, the head first.
    pub const ALL: [Self; 2] = [Self::Head, Self::Tail];

    /// The end's name in robot.toml and in messages: `head`, `tail`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::Tail => "tail",
        }
    }

    /// Indices (0 to 3 for A1 to A4) of the servos of the left and of the right crank: A1 and A2 at
    /// the head, A4 and A3 at the tail.
    pub const fn servos(self) -> [usize; 2] {
        match self {
            Self::Head => [0, 1],
            Self::Tail => [3, 2],
        }
    }

    /// The end to which a servo belongs; `servo` is an index in servo order, 0 to 3.
    pub const fn from_servo(servo: usize) -> Self {
        if servo < 2 { Self::Head } else { Self::Tail }
    }

    /// The direction of the end's y axis in the chassis frame: 1 forward, -1 backward. This factor
    /// converts angles, their rates, and y components between the two frames.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Head => 1.0,
            Self::Tail => -1.0,
        }
    }

    /// Converts a direction or a displacement from the chassis frame to the end's own frame, or back.
    #[inline(always)]
    pub fn mirror<T: Real>(self, vector: Vector<T>) -> Vector<T> {
        match self {
            Self::Head => vector,
            Self::Tail => vector.mirrored_in_x_axis(),
        }
    }

    /// Converts an angle from the chassis frame to the end's own frame, or back; degrees, (-180, 180].
    pub fn mirror_angle(self, degrees: f64) -> f64 {
        wrap(self.sign() * degrees)
    }

    /// Picks the values of the end's left and right cranks from four values in servo order.
    #[inline(always)]
    pub fn pick<T: Copy>(self, values: [T; 4]) -> [T; 2] {
        let [left, right] = self.servos();
        [values[left], values[right]]
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_servo_belongs_to_the_end_that_lists_it() {
        let mut end_counts = [0; 4];
        for end in End::ALL {
            for servo in end.servos() {
                end_counts[servo] += 1;
                assert_eq!(End::from_servo(servo), end);
            }
        }
        assert_eq!(end_counts, [1; 4]);
        assert_eq!(End::Tail.pick(["A1", "A2", "A3", "A4"]), ["A4", "A3"]);
    }

    #[test]
    fn only_the_tails_frame_is_mirrored() {
        assert_eq!(End::Tail.mirror_angle(221.5), 138.5);
        assert_eq!(End::Tail.mirror_angle(180.0), 180.0);
        assert_eq!(End::Head.mirror_angle(221.5), -138.5);
        let vector = Vector::new(3.0, 4.0);
        assert_eq!(End::Head.mirror(vector), vector);
        assert_eq!(End::Tail.mirror(vector), Vector::new(3.0, -4.0));
    }
}
