//! The things that the robot carries besides its mechanism: supply, terminal strips, straps.
//!
//! Shops have them in many sizes; the sizes here are the largest that fit on the robot.

/// Width of the battery's strap, and its thickness, mm.
pub const STRAP: [f64; 2] = [16.0, 1.5];

/// A thing that is bought and put on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitting {
    /// A converter that makes 5 V for the servos from the battery's voltage.
    Converter,
    /// A capacitor that keeps the servos' supply up when they start.
    Capacitor,
    /// An alarm that beeps before the battery is damaged.
    Alarm,
    /// A terminal strip that joins all grounds.
    Ground,
    /// A terminal strip that joins the servos' supply.
    Supply,
    /// A strap that holds the battery.
    Strap,
}

impl Fitting {
    /// Its name as a body; its mass, g, as shops give it; its size to the right, forward
    /// and up, mm.
    fn data(self) -> (&'static str, f64, [f64; 3]) {
        match self {
            Self::Converter => ("converter", 8.0, [18.0, 28.0, 8.0]),
            Self::Capacitor => ("capacitor", 2.0, [10.0, 20.0, 10.0]),
            Self::Alarm => ("alarm", 9.0, [25.0, 40.0, 9.0]),
            Self::Ground => ("ground strip", 12.0, [16.0, 84.0, 13.0]),
            Self::Supply => ("supply strip", 8.0, [16.0, 60.0, 13.0]),
            Self::Strap => ("battery strap", 3.0, [STRAP[0], 0.0, STRAP[1]]),
        }
    }

    /// Its name as a body.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.data().0
    }

    /// Its line in the list to buy.
    #[must_use]
    pub fn what(self) -> String {
        let [x, y, z] = self.size();
        let least = format!("at most {x} x {y} x {z} mm");
        match self {
            Self::Converter => format!("converter from 7.4 V to 5 V, 3 A, {least}"),
            Self::Capacitor => {
                format!("capacitor 1000 uF, 10 V or more, at most {x} mm thick and {y} mm long")
            }
            Self::Alarm => format!("low-voltage alarm for two lithium cells, {least}"),
            Self::Ground => format!("terminal strip, 12 ways, for ground, {least}"),
            Self::Supply => format!("terminal strip, 8 ways, for +5 V, {least}"),
            Self::Strap => format!("hook-and-loop strap, {x} mm wide, 150 mm long"),
        }
    }

    /// Its mass, g, as shops give it.
    #[must_use]
    pub fn grams(self) -> f64 {
        self.data().1
    }

    /// To the right, forward, up, mm.
    pub(crate) fn size(self) -> [f64; 3] {
        self.data().2
    }
}
