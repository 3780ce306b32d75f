//! What the robot carries besides its mechanism: supply, terminal strips, straps.
//!
//! Shops have them in many sizes; the sizes here are the largest that fit on the robot.

/// Width of the battery's strap, and its thickness, mm.
pub const STRAP: [f64; 2] = [16.0, 1.5];

/// A thing that is bought and put on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitting {
    /// Makes 5 V for the servos from the battery's voltage.
    Converter,
    /// Holds the servos' supply up when they start.
    Capacitor,
    /// Beeps before the battery is damaged.
    Alarm,
    /// Joins everything that belongs to ground.
    Ground,
    /// Joins the servos' supply.
    Supply,
    /// Holds the battery.
    Strap,
}

impl Fitting {
    /// Its name as a body.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converter => "converter",
            Self::Capacitor => "capacitor",
            Self::Alarm => "alarm",
            Self::Ground => "ground strip",
            Self::Supply => "supply strip",
            Self::Strap => "battery strap",
        }
    }

    /// What to buy.
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
        match self {
            Self::Converter => 8.0,
            Self::Capacitor => 2.0,
            Self::Alarm => 9.0,
            Self::Ground => 12.0,
            Self::Supply => 8.0,
            Self::Strap => 3.0,
        }
    }

    /// To the right, forward, up, mm.
    pub(crate) fn size(self) -> [f64; 3] {
        match self {
            Self::Converter => [18.0, 28.0, 8.0],
            Self::Capacitor => [10.0, 20.0, 10.0],
            Self::Alarm => [25.0, 40.0, 9.0],
            Self::Ground => [16.0, 84.0, 13.0],
            Self::Supply => [16.0, 60.0, 13.0],
            Self::Strap => [STRAP[0], 0.0, STRAP[1]],
        }
    }
}
