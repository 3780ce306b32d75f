//! The supplies as robot.toml describes them: the chip's reference voltage and the thresholds.

lizard_avr::plain! {
    /// The thresholds of one supply, mV. The robot reacts when the voltage falls below one of them.
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
        /// The chip's reference voltage, mV.
        pub reference: u16,
        /// The thresholds of the chip's own supply.
        pub board: Thresholds,
        /// The reference voltage times the ratio of the divider in front of the measured servo rail, mV; 0 if the
        /// rail is not measured.
        pub rail_reference: u16,
        /// The thresholds of the rail.
        pub rail: Thresholds,
    }
}
