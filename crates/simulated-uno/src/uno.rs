//! The simulated board: loads a program, runs it, sends bytes to it and records its outputs.

use std::ffi::CStr;
use std::path::Path;
use std::sync::Once;

use crate::ffi::{self, RawList, RawUno};
use crate::image::{FLASH_SIZE, Image, LoadError, SRAM_END};
use crate::traces::{Call, Mark, VectorStats};
use crate::{CYCLES_PER_MS, Edge, Pin, Pulse};

/// The model of the chip: stock simavr, or simavr with corrections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fidelity {
    /// Stock simavr 1.6: entering an interrupt takes no time, received bytes are never lost, and the 16-bit registers
    /// have no TEMP byte.
    Stock,
    /// simavr corrected to match the ATmega328P's data sheet: interrupt entry in 4 cycles (8 from sleep), a two-byte
    /// receive buffer with overrun, 10-bit frames, Timer1's TEMP byte, interrupt flags that are cleared one by one;
    /// EEPROM, ADC, watchdog, resets and brown-out with the times and limits of the data sheet.
    #[default]
    DataSheet,
}

/// The state of the simulated chip and its firmware.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum State {
    /// Running, asleep until an interrupt or a reset, or held in reset by the supply.
    Alive,
    /// Asleep with interrupts disabled. With [`Fidelity::DataSheet`], only while neither the watchdog nor a ramp or cut
    /// of the supply could reset the chip. [`Uno::reset`] and [`Uno::power_cycle`] end this; with
    /// [`Fidelity::DataSheet`], so does [`Uno::set_supply_mv`] with a voltage below the brown-out level.
    Halted,
    /// Stopped by an invalid instruction or address.
    Crashed {
        /// Byte address in flash.
        pc: u32,
        /// simavr's message.
        message: String,
    },
    /// Without power after [`Uno::cut_power`], until [`Uno::power_cycle`].
    Off,
}

/// A simulated Arduino UNO with firmware in its flash.
///
/// The argument for all `unsafe` code in this package: the pointer `raw` comes from the shim's constructor and is freed
/// only in `drop`, and nothing outside this struct keeps a copy. Therefore `raw` is valid wherever there is a `self`.
/// Functions of the shim that take a `const` pointer only read. They may be called with `&self`, because no other
/// thread can have a reference to the same `Uno` ([`Uno`] is not `Sync`). Functions that change something are called
/// with `&mut self`.
pub struct Uno {
    pub(crate) raw: *mut RawUno,
    image: Image,
    pub(crate) state: State,
}

// SAFETY: an instance owns everything that its pointer reaches. The only mutable state that all instances of libsimavr
// have in common is the logger, which is set once and finds the instance through the avr_t in its argument.
unsafe impl Send for Uno {}

impl Uno {
    /// Returns a board with the program from a file in flash, at the moment of power-on. [`Image::read`] reads the
    /// file.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(path: impl AsRef<Path>, fidelity: Fidelity) -> Result<Self, LoadError> {
        Ok(Self::with_image(Image::read(path)?, fidelity))
    }

    /// Returns a board with this image in flash, at the moment of power-on. Its pins D2 to D13 and A0 to A5 are
    /// recorded; D0 and D1 belong to the serial line.
    #[must_use]
    pub fn with_image(image: Image, fidelity: Fidelity) -> Self {
        static LOGGER: Once = Once::new();
        let follows_data_sheet = fidelity == Fidelity::DataSheet;
        let code = image.flash();
        let fits = code.len() <= FLASH_SIZE as usize;
        assert!(fits, "every segment of an image is inside flash");
        // SAFETY: the shim's constructor aborts instead of returning null; the code fits into the chip's flash.
        let raw = unsafe {
            LOGGER.call_once(|| ffi::uno_set_logger());
            let raw = ffi::uno_new(follows_data_sheet, Self::DEFAULT_BAUD);
            std::ptr::copy_nonoverlapping(code.as_ptr(), ffi::uno_flash(raw), code.len());
            ffi::uno_set_program_bounds(raw, image.code_end(), image.data_end());
            raw
        };
        Self {
            raw,
            image,
            state: State::Alive,
        }
    }

    /// The image in flash.
    #[must_use]
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The number of cycles since power-on.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_now(self.raw) }
    }

    /// The chip's time since power-on, ms.
    #[must_use]
    pub fn ms(&self) -> f64 {
        self.cycle() as f64 / CYCLES_PER_MS as f64
    }

    /// The firmware's state.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Runs until the cycle `end_cycle`, or up to a few hundred cycles longer if an instruction re-arms a timer just
    /// before `end_cycle`. Several short runs have the same result as one long run.
    pub fn run_until_cycle(&mut self, end_cycle: u64) -> &State {
        self.run_until_cycle_or_line(end_cycle, false);
        &self.state
    }

    /// Runs for a number of cycles. See [`Uno::run_until_cycle`].
    pub fn run_cycles(&mut self, cycles: u64) -> &State {
        self.run_until_cycle(self.cycle() + cycles)
    }

    /// Runs for a number of milliseconds of the chip's time. See [`Uno::run_until_cycle`].
    pub fn run_ms(&mut self, ms: u64) -> &State {
        self.run_cycles(ms * CYCLES_PER_MS)
    }

    /// Runs until the predicate holds; checks the predicate every `check_interval` cycles. Returns true if the
    /// predicate holds, and false if `max_cycles` have passed or the firmware has stopped.
    pub fn run_until(
        &mut self,
        max_cycles: u64,
        check_interval: u64,
        mut predicate: impl FnMut(&Self) -> bool,
    ) -> bool {
        let end = self.cycle() + max_cycles;
        while !predicate(self) {
            if self.cycle() >= end || self.state != State::Alive {
                return false;
            }
            self.run_until_cycle(end.min(self.cycle() + check_interval));
        }
        true
    }

    /// Runs until the cycle `end_cycle` or, if `stops_at_line`, until the firmware has sent a complete line. Returns
    /// true if a line ended the run.
    pub(crate) fn run_until_cycle_or_line(&mut self, end_cycle: u64, stops_at_line: bool) -> bool {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim stops at any cycle, and every
        // value that it returns is one of `StopReason`.
        let stop_reason = unsafe { ffi::uno_run(self.raw, end_cycle, stops_at_line) };
        match stop_reason {
            // A supply that was too low may have restarted a halted or crashed chip.
            ffi::StopReason::CycleReached | ffi::StopReason::LineSent => self.state = State::Alive,
            ffi::StopReason::Halted => self.state = State::Halted,
            ffi::StopReason::PowerCut => self.state = State::Off,
            ffi::StopReason::Crashed => {
                // SAFETY: `raw` is valid (see `Uno`). The message is inside the instance and
                // ends with a NUL, and nothing changes it while it is copied.
                let message = unsafe { CStr::from_ptr(ffi::uno_error_message(self.raw)) };
                self.state = State::Crashed {
                    pc: self.pc(),
                    message: message.to_string_lossy().trim().to_owned(),
                };
            }
        }
        stop_reason == ffi::StopReason::LineSent
    }

    /// The edges of D2 to D13 and A0 to A5 since power-on or the last [`Uno::take_edges`].
    #[must_use]
    pub fn edges(&self) -> Vec<Edge> {
        self.copy_items(ffi::uno_edges)
    }

    /// Removes and returns the edges recorded since power-on or the last call.
    pub fn take_edges(&mut self) -> Vec<Edge> {
        self.take_items(ffi::uno_edges)
    }

    /// The complete pulses of a pin among [`Uno::edges`].
    #[must_use]
    pub fn pulses(&self, pin: Pin) -> Vec<Pulse> {
        crate::pin::pulses(&self.edges(), pin)
    }

    /// True while a pin (D2 to D13, A0 to A5) is high.
    #[must_use]
    pub fn is_high(&self, pin: Pin) -> bool {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        let levels = unsafe { ffi::uno_pin_levels(self.raw) };
        levels & (1 << pin.number()) != 0
    }

    /// The firmware's stores to GPIOR0 since power-on or the last [`Uno::take_marks`].
    #[must_use]
    pub fn marks(&self) -> Vec<Mark> {
        self.copy_items(ffi::uno_marks)
    }

    /// Removes and returns the marks recorded since power-on or the last call.
    pub fn take_marks(&mut self) -> Vec<Mark> {
        self.take_items(ffi::uno_marks)
    }

    /// Runs for `cycles` and times every call of the function at this byte address in flash (see [`Image::symbol`]).
    /// Slower than [`Uno::run_cycles`], because it checks every instruction. A recursive call counts as part of the
    /// outermost call.
    pub fn time_calls(&mut self, entry_address: u32, cycles: u64) -> Vec<Call> {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim compares the address with the
        // program counter and never follows it.
        unsafe { ffi::uno_time_calls(self.raw, true, entry_address) };
        self.run_cycles(cycles);
        // SAFETY: as above.
        unsafe { ffi::uno_time_calls(self.raw, false, 0) };
        self.take_items(ffi::uno_calls)
    }

    /// The number of cycles since power-on in which the CPU slept.
    #[must_use]
    pub fn sleep_cycles(&self) -> u64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_sleep_cycles(self.raw) }
    }

    /// The number of cycles since power-on in which the CPU did not sleep.
    #[must_use]
    pub fn awake_cycles(&self) -> u64 {
        self.cycle() - self.sleep_cycles()
    }

    /// The number of resets by the watchdog so far. [`Uno::reset_events`] lists all resets.
    #[must_use]
    pub fn watchdog_reset_count(&self) -> u64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_watchdog_reset_count(self.raw) }
    }

    /// The largest size of the stack since power-on, bytes. At power-on, SRAM contains noise; a byte that differs from
    /// the noise counts as used.
    #[must_use]
    pub fn stack_used(&self) -> u16 {
        SRAM_END - self.lowest_stack_address()
    }

    /// The smallest gap between the stack and static data since power-on, bytes.
    #[must_use]
    pub fn stack_spare(&self) -> u16 {
        self.lowest_stack_address() - self.image.data_end()
    }

    /// The lowest SRAM address that the stack has reached.
    fn lowest_stack_address(&self) -> u16 {
        // SAFETY: `raw` is valid (see `Uno`); the shim looks through the chip's own SRAM.
        unsafe { ffi::uno_lowest_stack_address(self.raw) }
    }

    /// The byte address in flash of the next instruction.
    #[must_use]
    pub fn pc(&self) -> u32 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_pc(self.raw) }
    }

    /// The byte at a data address (registers, I/O or SRAM); 0 beyond SRAM.
    #[must_use]
    pub fn peek(&self, address: u16) -> u8 {
        // SAFETY: `raw` is valid (see `Uno`). The data space has at least `SRAM_END` bytes as long
        // as the instance lives, and nothing runs while they are borrowed.
        let data = unsafe { std::slice::from_raw_parts(ffi::uno_data(self.raw), SRAM_END.into()) };
        data.get(usize::from(address)).copied().unwrap_or(0)
    }

    /// Statistics of every interrupt that has been served at least once.
    #[must_use]
    pub fn interrupt_stats(&self) -> Vec<VectorStats> {
        // SAFETY: `raw` is valid (see `Uno`). The shim returns an array of `VECTOR_COUNT` items inside
        // the instance, and nothing runs while they are borrowed.
        let vectors =
            unsafe { std::slice::from_raw_parts(ffi::uno_vectors(self.raw), ffi::VECTOR_COUNT) };
        let served_vectors = vectors.iter().filter(|stats| stats.entry_count > 0);
        served_vectors.copied().collect()
    }

    /// Copies the items of one of the shim's lists.
    pub(crate) fn copy_items<Item: Copy>(&self, list_getter: ListGetter) -> Vec<Item> {
        // SAFETY: `raw` is valid (see `Uno`). The callers pair each list with its item type,
        // whose size is compared; the first `count` items are initialised, and nothing runs
        // while they are copied.
        unsafe {
            let list = &*list_getter(self.raw);
            assert_eq!(list.item_size, size_of::<Item>());
            match list.count {
                0 => Vec::new(),
                count => std::slice::from_raw_parts(list.items.cast(), count).to_vec(),
            }
        }
    }

    /// Removes and returns the items of one of the shim's lists.
    pub(crate) fn take_items<Item: Copy>(&mut self, list_getter: ListGetter) -> Vec<Item> {
        let items = self.copy_items(list_getter);
        self.clear_items(list_getter);
        items
    }

    /// Empties one of the shim's lists.
    pub(crate) fn clear_items(&mut self, list_getter: ListGetter) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); a list is inside the instance, and the
        // shim appends at `count`, so 0 empties the list.
        unsafe { (*list_getter(self.raw)).count = 0 }
    }
}

/// A function of the shim that returns one of its lists.
type ListGetter = unsafe extern "C" fn(*mut RawUno) -> *mut RawList;

impl Drop for Uno {
    fn drop(&mut self) {
        // SAFETY: `raw` comes from `uno_new` (see `Uno`), and is freed only here.
        unsafe { ffi::uno_free(self.raw) }
    }
}
