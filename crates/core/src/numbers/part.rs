//! The names of the robot's parts: servos, ends and sides.

/// A servo; every array of four has this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Servo {
    /// Front left, theta1; its leg is LF (left front).
    A1,
    /// Front right, theta4; its leg is RF (right front).
    A2,
    /// Hind right, theta8; its leg is RH (right hind).
    A3,
    /// Hind left, theta5; its leg is LH (left hind).
    A4,
}

/// An end of the body: a five-bar whose end point is the head or the tail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The five-bar at the front, between A1 and A2.
    Head,
    /// The five-bar at the rear, between A4 and A3.
    Tail,
}

/// A side of the body: a five-bar with a slider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side between A1 and A4.
    Left,
    /// The side between A2 and A3.
    Right,
}

impl Servo {
    /// All four servos, in their order.
    pub const ALL: [Self; 4] = [Self::A1, Self::A2, Self::A3, Self::A4];

    /// Iterates over all four servos; unlike [`Servo::ALL`], this requires no table in RAM.
    pub fn iter() -> impl Iterator<Item = Self> {
        (0..4).map(Self::at)
    }

    /// Returns the servo at an index of an array of four; A4 for an index past the end.
    pub const fn at(index: usize) -> Self {
        match index {
            0 => Self::A1,
            1 => Self::A2,
            2 => Self::A3,
            _ => Self::A4,
        }
    }

    /// True for a servo at the tail.
    pub const fn is_at_tail(self) -> bool {
        matches!(self, Self::A3 | Self::A4)
    }

    /// The servo's index in an array of four.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Picks this servo's element from an array in servo order.
    pub const fn pick<T>(self, items: &[T; 4]) -> &T {
        &items[self as usize]
    }

    /// Picks this servo's element, as a mutable reference, from an array in servo order.
    pub const fn pick_mut<T>(self, items: &mut [T; 4]) -> &mut T {
        &mut items[self as usize]
    }
}

impl End {
    /// The servos of the left and the right crank.
    pub const fn servos(self) -> [Servo; 2] {
        match self {
            Self::Head => [Servo::A1, Servo::A2],
            Self::Tail => [Servo::A4, Servo::A3],
        }
    }

    /// Both ends, the head first.
    pub const ALL: [Self; 2] = [Self::Head, Self::Tail];
}

impl Side {
    /// The servos of the front and the rear crank.
    pub const fn servos(self) -> [Servo; 2] {
        match self {
            Self::Left => [Servo::A1, Servo::A4],
            Self::Right => [Servo::A2, Servo::A3],
        }
    }

    /// Both sides, the left one first.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_servo_is_at_its_index_and_a4_past_the_end() {
        for index in 0..4 {
            assert_eq!(Servo::at(index).index(), index);
        }
        assert_eq!([4, 255].map(Servo::at), [Servo::A4; 2]);
    }
}
