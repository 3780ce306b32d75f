//! The supply voltages, measured by the analogue-to-digital converter.
//!
//! The converter compares a voltage with its own supply, AVcc. Therefore its reading of the chip's 1.1 V reference
//! determines AVcc without any external part. A conversion takes 104 us, the first one 200 us, and the reference
//! settles within 70 us after its selection (data sheet, sections 24.4 and 29.5). Therefore a frame selects the
//! channel, the next frame starts the conversion, and the frame after that reads the result.

use avr_device::atmega328p::ADC;
use lizard_core::control::supply::Reading;

/// The ADMUX bits that select AVcc as the converter's reference; the channel is added to them.
const AVCC_AS_REFERENCE: u8 = 0x40;

/// The channel of the chip's 1.1 V (bandgap) reference.
const BANDGAP_CHANNEL: u8 = 0x0e;

/// The Arduino number of the first analogue pin, A0.
const A0: u8 = 14;

/// The value of ADCSRA that switches the converter on, with a clock rate of 16 MHz / 128 = 125 kHz. A resolution of ten
/// bits requires 50 to 200 kHz.
const CONVERTER_ON: u8 = 0x87;
/// The bit of ADCSRA that starts a conversion.
const START_CONVERSION: u8 = 0x40;

/// The converter with its readings.
pub struct Converter {
    registers: ADC,
    reading: Reading,
    /// The channel of the servo rail, if the rail is measured.
    rail_channel: Option<u8>,
    /// True while the rail is being measured, false while the reference is being measured.
    is_measuring_rail: bool,
    /// True if a channel is selected, but its conversion has not been started yet.
    is_conversion_pending: bool,
    /// True once every voltage has been measured.
    is_complete: bool,
}

impl Converter {
    /// Creates the converter from its registers, switches it on, and selects the reference.
    pub fn new(registers: ADC) -> Self {
        select_channel(&registers, BANDGAP_CHANNEL);
        // SAFETY: any value of ADCSRA is valid; this value switches the converter on.
        registers.adcsra.write(|w| unsafe { w.bits(CONVERTER_ON) });
        Self {
            registers,
            reading: Reading::default(),
            rail_channel: None,
            is_measuring_rail: false,
            is_conversion_pending: true,
            is_complete: false,
        }
    }

    /// Connects the rail to the pin with this Arduino number; `None` if the rail is not measured.
    pub fn connect_rail(&mut self, pin: Option<u8>) {
        self.rail_channel = pin.map(|pin| pin.wrapping_sub(A0) & 7);
    }

    /// Starts the next part of a measurement. Returns the latest values, or an empty reading until every voltage has
    /// been measured. Call this function once per frame.
    pub fn advance_frame(&mut self) -> Reading {
        if self.is_conversion_pending {
            self.is_conversion_pending = false;
            // SAFETY: any value of ADCSRA is valid; this value also starts a conversion.
            self.registers
                .adcsra
                .write(|w| unsafe { w.bits(CONVERTER_ON | START_CONVERSION) });
        } else {
            let value = self.registers.adc.read().bits();
            self.store_value(value);
            self.is_conversion_pending = true;
        }
        if self.is_complete {
            self.reading
        } else {
            Reading::default()
        }
    }

    /// Stores the result of a conversion, and selects the channel of the next one.
    fn store_value(&mut self, value: u16) {
        match self.rail_channel {
            None => {
                self.reading.reference = value;
                self.is_complete = true;
            }
            Some(channel) => {
                if self.is_measuring_rail {
                    self.reading.rail = value;
                    self.is_complete = true;
                    select_channel(&self.registers, BANDGAP_CHANNEL);
                } else {
                    self.reading.reference = value;
                    select_channel(&self.registers, channel);
                }
                self.is_measuring_rail = !self.is_measuring_rail;
            }
        }
    }
}

fn select_channel(registers: &ADC, channel: u8) {
    // SAFETY: a UNO allows AVcc as the converter's reference, and `channel` exists.
    registers
        .admux
        .write(|w| unsafe { w.bits(AVCC_AS_REFERENCE | channel) });
}
