//! The supplies as robot.toml describes them: the reference of the chip and the thresholds.

lizard_avr::plain! {
    /// Voltages of one supply below which the robot reacts, mV, falling.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Thresholds {
        /// The voltage below which gaits slow down and the EEPROM is not written.
        pub slow: u16,
        /// The voltage below which the robot freezes.
        pub stop: u16,
        /// The voltage below which the pulses end.
        pub rest: u16,
    }
}

lizard_avr::plain! {
    /// The supplies, as in robot.toml.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Supplies {
        /// The chip's reference, mV.
        pub reference: u16,
        /// The thresholds of the chip's own supply.
        pub board: Thresholds,
        /// The reference times the ratio of the divider through which the servos' rail is
        /// measured, mV; 0 if it is not measured.
        pub rail_reference: u16,
        /// The thresholds of the rail.
        pub rail: Thresholds,
    }
}
