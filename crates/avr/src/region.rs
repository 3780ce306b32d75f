//! The region of flash after the program, which holds the robot's section and is written separately from the program.
//!
//! This data is not part of the program, so it has a fixed address that the linker does not choose. On an AVR this
//! address is a constant of the program, so a region takes no RAM, and reading it costs the same as reading a constant.
//! Every address of flash is readable, whatever its contents. On any other machine a region is a slice of ordinary
//! memory.

use crate::{Flash, Pod};

/// The region's first address. The code before it may occupy 27.5 KiB.
pub const START_ADDRESS: u16 = 0x6e00;

/// The address after the region: the start of an Arduino UNO's boot loader.
const END_ADDRESS: u16 = 0x7e00;

/// The size of the region in bytes.
pub const REGION_BYTES: u16 = END_ADDRESS - START_ADDRESS;

/// The region of flash that holds the robot's section.
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    #[cfg(not(target_arch = "avr"))]
    bytes: &'a [u8],
    #[cfg(target_arch = "avr")]
    marker: core::marker::PhantomData<&'a [u8]>,
}

#[cfg(not(target_arch = "avr"))]
impl<'a> Region<'a> {
    /// The region before a robot is opened: on a host, it is empty.
    pub const DEFAULT: Self = Self { bytes: &[] };

    /// Creates a region that consists of these bytes.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The region's bytes.
    pub const fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// The region's size in bytes, at most [`REGION_BYTES`].
    pub const fn size(self) -> u16 {
        let length = self.bytes.len();
        if length > REGION_BYTES as usize {
            REGION_BYTES
        } else {
            length as u16
        }
    }

    /// The region's first `length` bytes; all of its bytes if it has fewer.
    pub fn prefix(self, length: u16) -> Self {
        Self::new(self.bytes.get(..length.into()).unwrap_or(self.bytes))
    }

    /// Reads the value whose bytes begin at `offset`. If that value is not entirely within the region, returns an
    /// all-zero value; debug builds panic instead, unless the region is empty.
    pub fn read<T: Pod>(self, offset: u16) -> T {
        self.debug_assert_in_bounds(offset, size_of::<T>());
        Flash::from(self.bytes).read(offset.into())
    }

    /// Returns `count` values whose bytes begin at `offset`. If they are not entirely within the region, returns an
    /// empty slice; debug builds panic instead, unless the region is empty.
    pub fn values<T: Pod>(self, offset: u16, count: u16) -> Flash<'a, [T]> {
        let length = usize::from(count) * size_of::<T>();
        self.debug_assert_in_bounds(offset, length);
        let bytes = Flash::from(self.bytes).subslice(offset.into(), length);
        bytes.map_or(Flash::EMPTY, Flash::cast)
    }

    fn debug_assert_in_bounds(self, offset: u16, length: usize) {
        debug_assert!(
            self.bytes.is_empty() || usize::from(offset) + length <= self.bytes.len(),
            "{length} bytes at {offset} are outside the region of {} bytes",
            self.bytes.len()
        );
    }
}

#[cfg(target_arch = "avr")]
impl<'a> Region<'a> {
    /// The region of the robot's section, the only one on an AVR.
    pub const DEFAULT: Self = Self {
        marker: core::marker::PhantomData,
    };

    /// The region's size in bytes.
    #[inline(always)]
    pub const fn size(self) -> u16 {
        REGION_BYTES
    }

    /// Returns the whole region: an AVR needs no length, because all offsets into the section have been checked before.
    #[inline(always)]
    pub const fn prefix(self, _length: u16) -> Self {
        self
    }

    /// Reads the value whose bytes begin at `offset`, without bounds checking.
    #[inline(always)]
    pub fn read<T: Pod>(self, offset: u16) -> T {
        let pointer =
            core::ptr::with_exposed_provenance(usize::from(START_ADDRESS.wrapping_add(offset)));
        // SAFETY: every address of flash is readable, any bit pattern is a valid `T`, and the program does not write
        // its flash.
        unsafe { Flash::new(pointer) }.load()
    }

    /// Returns `count` values whose bytes begin at `offset`, without bounds checking.
    #[inline(always)]
    pub fn values<T: Pod>(self, offset: u16, count: u16) -> Flash<'a, [T]> {
        let pointer =
            core::ptr::with_exposed_provenance(usize::from(START_ADDRESS.wrapping_add(offset)));
        // SAFETY: as in `read`.
        unsafe { Flash::new(core::ptr::slice_from_raw_parts(pointer, usize::from(count))) }
    }
}
