//! The supplies in robot.toml: the chip's reference voltage and the thresholds.

lizard_avr::pod! {
    /// The voltages of a supply below which the robot reacts.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Thresholds {
        /// The voltage below which gaits slow down and the EEPROM is not written, mV.
        pub slow_mv: u16,
        /// The voltage below which the robot freezes, mV.
        pub stop_mv: u16,
        /// The voltage below which the pulses end, mV.
        pub rest_mv: u16,
    }
}

lizard_avr::pod! {
    /// The supplies of the chip and the servos.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Supplies {
        /// The chip's reference voltage, mV.
        pub reference_mv: u16,
        /// The thresholds of the chip's own supply.
        pub board: Thresholds,
        /// The reference voltage times the divider's ratio (rail voltage / pin voltage), mV; 0 if the rail is not
        /// measured.
        pub rail_reference_mv: u16,
        /// The thresholds of the servo rail.
        pub rail: Thresholds,
    }
}
