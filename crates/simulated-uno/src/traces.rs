//! Records of a run besides edges: bytes, marks, calls, interrupts.

/// A byte on the serial line.
///
/// The cycle of a byte that the UNO sent is the end of its stop bit in [`crate::Fidelity::DataSheet`],
/// and the store to UDR0 in [`crate::Fidelity::Stock`], which has no frames.
// `struct serial_byte` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct SerialByte {
    /// Cycle since power-on.
    pub cycle: u64,
    /// The byte.
    pub byte: u8,
}

/// A store to GPIOR0: a mark in the record that costs the firmware one cycle.
// `struct mark` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Mark {
    /// Cycle since power-on.
    pub cycle: u64,
    /// The value stored.
    pub value: u8,
}

/// One timed call of a function.
// `struct call` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Call {
    /// Cycle of the first instruction.
    pub enter: u64,
    /// Cycle after the return.
    pub leave: u64,
    /// Cycles taken by interrupts in between, entry and `reti` included.
    pub interrupted: u64,
}

impl Call {
    /// Cycles from entry to return, interrupts included.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.leave - self.enter
    }

    /// Cycles of the function alone.
    #[must_use]
    pub fn own_cycles(&self) -> u64 {
        self.cycles() - self.interrupted
    }
}

/// The number of times that an interrupt was served, and the cycles of its handler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VectorUse {
    /// Vector number, as in the data sheet's table minus one (0 is reset).
    pub vector: u8,
    /// The number of times that it was served.
    pub entries: u64,
    /// The sum of the cycles in its handler.
    pub cycles: u64,
}

/// The data sheet's name of an interrupt vector.
#[must_use]
pub fn vector_name(vector: u8) -> &'static str {
    const NAMES: &str = "RESET INT0 INT1 PCINT0 PCINT1 PCINT2 WDT TIMER2_COMPA TIMER2_COMPB TIMER2_OVF \
        TIMER1_CAPT TIMER1_COMPA TIMER1_COMPB TIMER1_OVF TIMER0_COMPA TIMER0_COMPB TIMER0_OVF SPI_STC USART_RX \
        USART_UDRE USART_TX ADC EE_READY ANALOG_COMP TWI SPM_READY";
    NAMES.split(' ').nth(vector.into()).unwrap_or("?")
}
