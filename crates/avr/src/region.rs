//! The flash after the program, which holds the robot's section and is written separately
//! from the program.
//!
//! Data that is written without a compiler lies at a fixed address. On an AVR that address is a constant of
//! the program, so a region takes no RAM, and reading it costs the same as reading a constant. Every address of flash
//! can be read, whatever it holds. On any other machine a region is a slice of ordinary memory.

use crate::{Flash, Plain};

/// True if avr-gcc links the program without tools/linker. That linker makes the code shorter, so without it the region
/// begins later. Such a build is for simulators only, so the region may take the place of a UNO's boot loader.
const IS_PLAIN_LINK: bool = match option_env!("LIZARD_PLAIN_LINK") {
    Some(value) => matches!(value.as_bytes(), b"1"),
    None => false,
};

/// The region's first address. Before it there is room for 27.5 KiB of code, or for 29.9 KiB if avr-gcc alone links.
pub const START_ADDRESS: u16 = if IS_PLAIN_LINK { 0x7780 } else { 0x6e00 };

/// The address after the region: where the boot loader of an Arduino UNO begins, or the flash ends.
const END_ADDRESS: u16 = if IS_PLAIN_LINK { 0x8000 } else { 0x7e00 };

/// The size of the region in bytes.
pub const SPACE_BYTES: u16 = END_ADDRESS - START_ADDRESS;

/// The region of flash that holds the robot's section.
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    #[cfg(not(target_arch = "avr"))]
    bytes: &'a [u8],
    #[cfg(target_arch = "avr")]
    lifetime: core::marker::PhantomData<&'a [u8]>,
}

#[cfg(not(target_arch = "avr"))]
impl<'a> Region<'a> {
    /// The region that a program starts with: on a host, no bytes.
    pub const INITIAL: Self = Self { bytes: &[] };

    /// Creates a region of these bytes.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The region's bytes.
    pub const fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// The region's size in bytes, at most [`SPACE_BYTES`].
    pub const fn size(self) -> u16 {
        let length = self.bytes.len();
        if length > SPACE_BYTES as usize {
            SPACE_BYTES
        } else {
            length as u16
        }
    }

    /// The region's first `length` bytes; all of its bytes if it has fewer.
    pub fn prefix(self, length: u16) -> Self {
        Self::new(self.bytes.get(..length.into()).unwrap_or(self.bytes))
    }

    /// Reads the value whose bytes begin at `offset`; a value of zeros if it is not completely within the region.
    /// Debug builds panic in that case, unless the region is empty.
    pub fn read<T: Plain>(self, offset: u16) -> T {
        self.assert_has(offset, size_of::<T>());
        Flash::from(self.bytes).read(offset.into())
    }

    /// Returns `count` values whose bytes begin at `offset`; an empty slice if they are not completely within the
    /// region. Debug builds panic in that case, unless the region is empty.
    pub fn values<T: Plain>(self, offset: u16, count: u16) -> Flash<'a, [T]> {
        let length = usize::from(count) * size_of::<T>();
        self.assert_has(offset, length);
        let bytes = Flash::from(self.bytes).subslice(offset.into(), length);
        bytes.map_or(Flash::EMPTY, Flash::cast)
    }

    fn assert_has(self, offset: u16, length: usize) {
        debug_assert!(
            self.bytes.is_empty() || usize::from(offset) + length <= self.bytes.len(),
            "{length} bytes at {offset} are not in a region of {}",
            self.bytes.len()
        );
    }
}

#[cfg(target_arch = "avr")]
impl<'a> Region<'a> {
    /// The region that a program starts with: on an AVR the only region, that of the robot's section.
    pub const INITIAL: Self = Self {
        lifetime: core::marker::PhantomData,
    };

    /// The region's size in bytes.
    #[inline(always)]
    pub const fn size(self) -> u16 {
        SPACE_BYTES
    }

    /// The region's first `length` bytes. The length is not stored, since all offsets into a
    /// section have been checked.
    #[inline(always)]
    pub const fn prefix(self, _length: u16) -> Self {
        self
    }

    /// Reads the value whose bytes begin at `offset`, without a check of the bounds.
    #[inline(always)]
    pub fn read<T: Plain>(self, offset: u16) -> T {
        let pointer =
            core::ptr::with_exposed_provenance(usize::from(START_ADDRESS.wrapping_add(offset)));
        // SAFETY: every address of flash can be read, and any bytes are a value; the
        // program does not write its flash.
        unsafe { Flash::new(pointer) }.load()
    }

    /// Returns `count` values whose bytes begin at `offset`, without a check of the bounds.
    #[inline(always)]
    pub fn values<T: Plain>(self, offset: u16, count: u16) -> Flash<'a, [T]> {
        let pointer =
            core::ptr::with_exposed_provenance(usize::from(START_ADDRESS.wrapping_add(offset)));
        // SAFETY: every address of flash can be read, and any bytes are values; the
        // program does not write its flash.
        unsafe { Flash::new(core::ptr::slice_from_raw_parts(pointer, usize::from(count))) }
    }
}
