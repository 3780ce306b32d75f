//! A region of flash behind the program, which is not part of it.
//!
//! Data that is written without a compiler lies at a fixed address. On the AVR that
//! address is a constant of the program, so a region takes no RAM and reading it costs
//! what reading a constant does; any address can be read, whatever is there. On any
//! other machine a region is a slice of ordinary memory.

use crate::{Flash, Plain};

/// Where the region begins, and how many bytes it has: from behind 26.5 KiB of code up to
/// the boot loader of an Arduino UNO.
pub const START: u16 = 0x6a00;

/// How many bytes the region has.
pub const SPACE: u16 = 0x7e00 - START;

/// The region.
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    #[cfg(not(target_arch = "avr"))]
    bytes: &'a [u8],
    #[cfg(target_arch = "avr")]
    lifetime: core::marker::PhantomData<&'a [u8]>,
}

#[cfg(not(target_arch = "avr"))]
impl<'a> Region<'a> {
    /// Nothing.
    pub const EMPTY: Self = Self { bytes: &[] };

    /// These bytes, and nothing behind them.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// Its bytes.
    pub const fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// How many bytes it has, at most [`SPACE`].
    pub const fn len(self) -> u16 {
        let len = self.bytes.len();
        if len > SPACE as usize {
            SPACE
        } else {
            len as u16
        }
    }

    /// The value whose bytes begin at `at`; where it is not wholly there, one of zeros.
    pub fn read<T: Plain>(self, at: u16) -> T {
        Flash::from(self.bytes).read(at.into())
    }

    /// `count` values whose bytes begin at `at`; none where they are not wholly there.
    pub fn values<T: Plain>(self, at: u16, count: u16) -> Flash<'a, [T]> {
        let length = usize::from(count) * size_of::<T>();
        let part = Flash::from(self.bytes).part(at.into(), length);
        part.map_or(Flash::EMPTY, Flash::of)
    }
}

#[cfg(target_arch = "avr")]
impl<'a> Region<'a> {
    /// The region.
    pub const EMPTY: Self = Self {
        lifetime: core::marker::PhantomData,
    };

    /// How many bytes it has.
    #[inline(always)]
    pub const fn len(self) -> u16 {
        SPACE
    }

    /// The value whose bytes begin at `at`.
    #[inline(always)]
    pub fn read<T: Plain>(self, at: u16) -> T {
        let first = core::ptr::with_exposed_provenance(usize::from(START.wrapping_add(at)));
        // SAFETY: every address of flash can be read, and any bytes are a value; the
        // program does not write its flash.
        unsafe { Flash::new(first) }.load()
    }

    /// `count` values whose bytes begin at `at`.
    #[inline(always)]
    pub fn values<T: Plain>(self, at: u16, count: u16) -> Flash<'a, [T]> {
        let first = core::ptr::with_exposed_provenance(usize::from(START.wrapping_add(at)));
        // SAFETY: as above.
        unsafe { Flash::new(core::ptr::slice_from_raw_parts(first, usize::from(count))) }
    }
}
