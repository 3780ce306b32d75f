//! Declarations of the C functions in `shim/`, which are documented in `shim/uno.h`. This module is private;
//! [`crate::Uno`] is the safe interface to these functions. The items of the shim's lists are public types with C
//! layout: [`crate::Edge`], [`crate::SerialByte`] and others.

use std::ffi::{c_char, c_void};

use crate::VectorStats;

/// Opaque `struct uno`, accessed only by the shim.
#[repr(C)]
pub struct RawUno {
    _opaque: [u8; 0],
}

/// `struct list` of the shim: a growing array.
#[repr(C)]
pub struct RawList {
    pub items: *mut c_void,
    /// The number of items in use.
    pub count: usize,
    /// The number of items for which memory is allocated.
    pub capacity: usize,
    /// The size of an item, bytes.
    pub item_size: usize,
}

/// The number of interrupt vectors, `CHIP_VECTOR_COUNT` of the shim.
pub const VECTOR_COUNT: usize = 26;

/// `enum stop_reason` of the shim: the reason for the end of a run.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
#[expect(dead_code, reason = "only the shim constructs these values")]
pub enum StopReason {
    /// The requested cycle was reached.
    CycleReached,
    /// The firmware has sent a line feed.
    LineSent,
    /// The CPU sleeps, and nothing can wake it.
    Halted,
    /// The firmware has executed an invalid instruction or used an invalid address.
    Crashed,
    /// The power was cut.
    PowerCut,
}

unsafe extern "C" {
    pub fn uno_set_logger();
    pub fn uno_new(follows_data_sheet: bool, baud: f64) -> *mut RawUno;
    pub fn uno_free(uno: *mut RawUno);
    pub fn uno_set_program_bounds(uno: *mut RawUno, code_end: u32, data_end: u16);
    pub fn uno_set_boot_address(uno: *mut RawUno, address: u32);
    pub fn uno_flash(uno: *mut RawUno) -> *mut u8;
    pub fn uno_run(uno: *mut RawUno, until: u64, stops_at_line: bool) -> StopReason;
    pub fn uno_time_calls(uno: *mut RawUno, is_enabled: bool, entry_address: u32);
    pub fn uno_send(uno: *mut RawUno, bytes: *const u8, length: usize, is_stop_bit_low: bool);
    pub fn uno_set_flood(uno: *mut RawUno, bytes: *const u8, length: usize);
    pub fn uno_set_baud(uno: *mut RawUno, baud: f64);
    pub fn uno_cycles_per_bit(uno: *const RawUno) -> u32;
    pub fn uno_block_cpu(uno: *mut RawUno, cycles: u64);
    pub fn uno_stall_main(uno: *mut RawUno, until: u64);
    pub fn uno_poke(uno: *mut RawUno, address: u16, value: u8);
    pub fn uno_unsent_count(uno: *const RawUno) -> usize;
    pub fn uno_sent_count(uno: *const RawUno) -> u64;
    pub fn uno_now(uno: *const RawUno) -> u64;
    pub fn uno_sleep_cycles(uno: *const RawUno) -> u64;
    pub fn uno_pc(uno: *const RawUno) -> u32;
    pub fn uno_watchdog_reset_count(uno: *const RawUno) -> u64;
    pub fn uno_overrun_count(uno: *const RawUno) -> u64;
    pub fn uno_pin_levels(uno: *const RawUno) -> u32;
    pub fn uno_lowest_stack_address(uno: *const RawUno) -> u16;
    pub fn uno_error_message(uno: *const RawUno) -> *const c_char;
    pub fn uno_data(uno: *const RawUno) -> *const u8;
    pub fn uno_vectors(uno: *const RawUno) -> *const VectorStats;
    pub fn uno_edges(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_transmitted(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_received(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_marks(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_calls(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_reset(uno: *mut RawUno);
    pub fn uno_power_cycle(uno: *mut RawUno);
    pub fn uno_set_boot_loader(uno: *mut RawUno, is_present: bool);
    pub fn uno_set_noise_seed(uno: *mut RawUno, seed: u64);
    pub fn uno_is_held_in_reset(uno: *const RawUno) -> bool;
    pub fn uno_reset_events(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_eeprom(uno: *mut RawUno) -> *mut u8;
    pub fn uno_eeprom_operations(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_set_torn_bits(uno: *mut RawUno, ones: u8);
    pub fn uno_cut_power_at(uno: *mut RawUno, cycle: u64);
    pub fn uno_cut_power_in_operation(uno: *mut RawUno, skip_count: u64, in_write: bool);
    pub fn uno_cancel_power_cut(uno: *mut RawUno);
    pub fn uno_supply_mv(uno: *const RawUno) -> f64;
    pub fn uno_ramp_supply(uno: *mut RawUno, mv: f64, cycles: u64);
    pub fn uno_set_brown_out(uno: *mut RawUno, mv: f64);
    pub fn uno_set_bandgap(uno: *mut RawUno, mv: f64);
    pub fn uno_set_contact(uno: *mut RawUno, number: u8, is_closed: bool);
    pub fn uno_set_analog(uno: *mut RawUno, channel: u8, mv: u16);
    /// Returns the byte that a receiver reads if its bits are `ratio` times as long as the sender's. It is declared in
    /// `shim/usart.h`.
    // Safe, because it only computes with two numbers.
    pub safe fn usart_sample_byte(byte: u8, ratio: f64) -> u8;
}
