//! A region of flash behind the program, which is not part of it.
//!
//! Data that is written without a compiler lies at a fixed address. On the AVR that
//! address is a constant of the program, so a region takes no RAM and reading it costs
//! what reading a constant does; any address can be read, whatever is there. On any
//! other machine a region is a slice of ordinary memory.

use crate::{Flash, Plain};

/// True in a build whose code is longer, because avr-gcc alone links it. It is for simulators,
/// so its region may end where the flash does, behind an UNO's boot loader.
const IS_PLAIN: bool = match option_env!("LIZARD_PLAIN_LINK") {
    Some(set) => matches!(set.as_bytes(), b"1"),
    None => false,
};

/// Where the region begins, and how many bytes it has: from behind 27.5 KiB of code up to
/// the boot loader of an Arduino UNO.
pub const START: u16 = if IS_PLAIN { 0x7780 } else { 0x6e00 };

/// How many bytes the region has.
pub const SPACE: u16 = if IS_PLAIN { 0x8000 } else { 0x7e00 } - START;

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
    pub const fn size(self) -> u16 {
        let len = self.bytes.len();
        if len > SPACE as usize {
            SPACE
        } else {
            len as u16
        }
    }

    /// Its first `length` bytes: what is behind them is no part of it.
    pub fn first(self, length: u16) -> Self {
        Self::new(self.bytes.get(..length.into()).unwrap_or(self.bytes))
    }

    /// The value whose bytes begin at `at`; where it is not wholly there, one of zeros.
    /// Of a region that is not empty nobody should ask for that, and a test does not let
    /// it pass.
    pub fn read<T: Plain>(self, at: u16) -> T {
        self.must_have(at, size_of::<T>());
        Flash::from(self.bytes).read(at.into())
    }

    /// `count` values whose bytes begin at `at`; none where they are not wholly there,
    /// likewise.
    pub fn values<T: Plain>(self, at: u16, count: u16) -> Flash<'a, [T]> {
        let length = usize::from(count) * size_of::<T>();
        self.must_have(at, length);
        let part = Flash::from(self.bytes).part(at.into(), length);
        part.map_or(Flash::EMPTY, Flash::of)
    }

    fn must_have(self, at: u16, length: usize) {
        debug_assert!(
            self.bytes.is_empty() || usize::from(at) + length <= self.bytes.len(),
            "{length} bytes at {at} are not in a region of {}",
            self.bytes.len()
        );
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
    pub const fn size(self) -> u16 {
        SPACE
    }

    /// Its first `length` bytes, of which nothing is kept here: what reads them has been
    /// checked.
    #[inline(always)]
    pub const fn first(self, _length: u16) -> Self {
        self
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
