//! Records of a run other than edges: serial bytes, marks, calls and interrupts.

/// A byte on the serial line.
///
/// For a byte from the UNO, `cycle` is the end of the stop bit with [`crate::Fidelity::DataSheet`], and the store to
/// UDR0 with [`crate::Fidelity::Stock`], which simulates no frames.
// `struct serial_byte` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct SerialByte {
    /// Cycle since power-on.
    pub cycle: u64,
    /// The value of the byte.
    pub value: u8,
}

/// A store to GPIOR0, with which firmware marks an event at the cost of one cycle.
// `struct mark` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Mark {
    /// Cycle since power-on.
    pub cycle: u64,
    /// The value that was stored.
    pub value: u8,
}

/// One timed call of a function.
// `struct call` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Call {
    /// Cycle of the first instruction.
    pub enter_cycle: u64,
    /// Cycle after the return.
    pub leave_cycle: u64,
    /// Cycles of the interrupts during the call, including their entry and `reti`.
    pub interrupt_cycles: u64,
}

impl Call {
    /// Cycles from the first instruction to the return, including interrupts.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.leave_cycle - self.enter_cycle
    }

    /// Cycles from the first instruction to the return, without interrupts.
    #[must_use]
    pub fn own_cycles(&self) -> u64 {
        self.cycles() - self.interrupt_cycles
    }
}

/// Statistics of one interrupt.
// `struct vector_stats` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct VectorStats {
    /// The vector number, counted from 0 (reset); the data sheet's table counts from 1.
    pub vector: u8,
    /// The number of times that the interrupt was served.
    pub entry_count: u64,
    /// The total number of cycles in the interrupt's handler.
    pub cycles: u64,
}

/// Returns the data sheet's name for an interrupt vector, or `?` if the chip has no such vector.
#[must_use]
pub fn vector_name(vector: u8) -> &'static str {
    const NAMES: &str = "RESET INT0 INT1 PCINT0 PCINT1 PCINT2 WDT TIMER2_COMPA TIMER2_COMPB TIMER2_OVF \
        TIMER1_CAPT TIMER1_COMPA TIMER1_COMPB TIMER1_OVF TIMER0_COMPA TIMER0_COMPB TIMER0_OVF SPI_STC USART_RX \
        USART_UDRE USART_TX ADC EE_READY ANALOG_COMP TWI SPM_READY";
    NAMES.split(' ').nth(vector.into()).unwrap_or("?")
}
