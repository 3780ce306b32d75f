//! Declarations of the C functions in `shim/`. This module is private; [`crate::Uno`] is the safe interface to these
//! functions. The items of the shim's lists are public types with C layout: [`crate::Edge`], [`crate::SerialByte`]
//! and others.

use std::ffi::{c_char, c_void};

/// `struct uno` of the shim, which only the shim reads and writes.
#[repr(C)]
pub struct RawUno {
    _opaque: [u8; 0],
}

/// `struct list` of the shim: a growing array.
#[repr(C)]
pub struct RawList {
    pub items: *mut c_void,
    pub count: usize,
    pub room: usize,
    pub size: usize,
}

/// `struct vector_use` of the shim: the entries and the cycles of an interrupt vector.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RawVector {
    pub entries: u64,
    pub cycles: u64,
}

/// The number of interrupt vectors, `CHIP_VECTORS` of the shim.
pub const VECTORS: usize = 26;

/// `enum stop` of the shim: the reason why a run has ended.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
#[expect(dead_code, reason = "the shim makes these values")]
pub enum Stop {
    Time,
    Line,
    Halted,
    Crashed,
    Off,
}

unsafe extern "C" {
    pub fn uno_set_logger();
    pub fn uno_new(data_sheet: bool, pins: u32, baud: f64) -> *mut RawUno;
    pub fn uno_free(uno: *mut RawUno);
    pub fn uno_load(uno: *mut RawUno, code: *const u8, size: u32, address: u32) -> bool;
    pub fn uno_power_on(uno: *mut RawUno, code_end: u32, data_end: u16);
    pub fn uno_boot_at(uno: *mut RawUno, address: u32);
    pub fn uno_flash(uno: *mut RawUno) -> *mut u8;
    pub fn uno_run(uno: *mut RawUno, until: u64) -> Stop;
    pub fn uno_stop_at_line(uno: *mut RawUno, on: bool);
    pub fn uno_time_calls(uno: *mut RawUno, on: bool, entry: u32);
    pub fn uno_send(uno: *mut RawUno, bytes: *const u8, length: usize, stop_low: bool);
    pub fn uno_flood(uno: *mut RawUno, bytes: *const u8, length: usize);
    pub fn uno_set_baud(uno: *mut RawUno, baud: f64);
    pub fn uno_cycles_per_bit(uno: *const RawUno) -> u32;
    pub fn uno_sampled(byte: u8, ratio: f64) -> u8;
    pub fn uno_hold(uno: *mut RawUno, cycles: u64);
    pub fn uno_stall_main(uno: *mut RawUno, until: u64);
    pub fn uno_poke(uno: *mut RawUno, address: u16, value: u8);
    pub fn uno_unsent(uno: *const RawUno) -> usize;
    pub fn uno_sent(uno: *const RawUno) -> u64;
    pub fn uno_now(uno: *const RawUno) -> u64;
    pub fn uno_asleep(uno: *const RawUno) -> u64;
    pub fn uno_pc(uno: *const RawUno) -> u32;
    pub fn uno_resets(uno: *const RawUno) -> u64;
    pub fn uno_overruns(uno: *const RawUno) -> u64;
    pub fn uno_levels(uno: *const RawUno) -> u32;
    pub fn uno_stack_low(uno: *const RawUno) -> u16;
    pub fn uno_message(uno: *const RawUno) -> *const c_char;
    pub fn uno_data(uno: *const RawUno) -> *const u8;
    pub fn uno_data_size(uno: *const RawUno) -> u32;
    pub fn uno_vectors(uno: *const RawUno) -> *const RawVector;
    pub fn uno_edges(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_transmitted(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_received(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_marks(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_calls(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_reset(uno: *mut RawUno);
    pub fn uno_power_cycle(uno: *mut RawUno);
    pub fn uno_set_boot_loader(uno: *mut RawUno, on: bool);
    pub fn uno_set_noise(uno: *mut RawUno, seed: u64);
    pub fn uno_held_in_reset(uno: *const RawUno) -> bool;
    pub fn uno_reset_events(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_eeprom(uno: *mut RawUno) -> *mut u8;
    pub fn uno_eeprom_operations(uno: *mut RawUno) -> *mut RawList;
    pub fn uno_set_torn_ones(uno: *mut RawUno, ones: u8);
    pub fn uno_cut_power_at(uno: *mut RawUno, cycle: u64);
    pub fn uno_cut_power_in_operation(uno: *mut RawUno, skip: u64, in_write: bool);
    pub fn uno_keep_power(uno: *mut RawUno);
    pub fn uno_supply(uno: *const RawUno) -> f64;
    pub fn uno_ramp_supply(uno: *mut RawUno, mv: f64, cycles: u64);
    pub fn uno_set_brown_out(uno: *mut RawUno, mv: f64);
    pub fn uno_set_bandgap(uno: *mut RawUno, mv: f64);
    pub fn uno_set_contact(uno: *mut RawUno, address: u16, bit: u8, closed: bool);
    pub fn uno_set_analog(uno: *mut RawUno, channel: u8, mv: u16);
}
