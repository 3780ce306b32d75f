//! Constants that stay in flash.
//!
//! An AVR has two address spaces: data and flash. A Rust `static` is in the data space: it is copied to RAM at start,
//! and an ATmega328P has only 2 KiB of RAM. Tables and messages belong in flash, which only the `lpm` instruction
//! reads. [`flash!`](crate::flash!) puts a constant there. A [`Flash`] is the constant's address, and reading through
//! it is the only access to the constant. On any other machine a [`Flash`] is an ordinary reference, so the same code
//! runs there, even with tables made at run time.
//!
//! No access panics: [`Flash::at`] and [`Flash::get`] limit an index past the end to the last element, so the program
//! needs no code for a panic.

use core::marker::PhantomData;
#[cfg(target_arch = "avr")]
use core::mem::{MaybeUninit, transmute_copy};
use core::ptr::NonNull;

/// The address of a constant in flash; on any other machine, an ordinary reference.
pub struct Flash<'a, T: ?Sized> {
    address: NonNull<T>,
    marker: PhantomData<&'a T>,
}

impl<T: ?Sized> Clone for Flash<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: ?Sized> Copy for Flash<'_, T> {}

// SAFETY: by the contract of `Flash::new`, the value at `address` is not written while a `Flash` exists, so readers on
// all threads see the same value.
unsafe impl<T: ?Sized + Sync> Sync for Flash<'_, T> {}
// SAFETY: as above.
unsafe impl<T: ?Sized + Sync> Send for Flash<'_, T> {}

impl<T: ?Sized> Flash<'_, T> {
    /// Creates a reference to the constant at `address`. Public only for [`flash!`](crate::flash!).
    ///
    /// # Safety
    /// For the whole lifetime, a value of `T` must be at `address` and must not be written. On an AVR `address` must be
    /// in flash, on any other machine in ordinary memory. `address` need not be aligned.
    #[doc(hidden)]
    pub const unsafe fn new(address: *const T) -> Self {
        Self {
            // SAFETY: a value is at `address`, so `address` is not 0, where the interrupt vectors are.
            address: unsafe { NonNull::new_unchecked(address.cast_mut()) },
            marker: PhantomData,
        }
    }
}

/// Wraps a table that was made at run time, which only a host does.
#[cfg(not(target_arch = "avr"))]
impl<'a, T: ?Sized> From<&'a T> for Flash<'a, T> {
    fn from(value: &'a T) -> Self {
        // SAFETY: for its lifetime, a reference is valid for reads, and its value does not change.
        unsafe { Self::new(value) }
    }
}

impl<T: Copy> Flash<'_, T> {
    /// Reads the constant from flash.
    #[cfg(not(target_arch = "avr"))]
    #[inline]
    pub fn load(self) -> T {
        // SAFETY: by the contract of `new`, a value of `T` is at `self.address`; `T` is `Copy`.
        unsafe { self.address.as_ptr().read_unaligned() }
    }

    /// Reads the constant from flash.
    #[cfg(target_arch = "avr")]
    #[inline]
    pub fn load(self) -> T {
        // One or two bytes are loaded into registers, larger values into memory.
        if size_of::<T>() == 1 {
            // SAFETY: by the contract of `new`, the byte at `self.address` is a `T`; a bitwise copy of a `Copy` value
            // is a valid value.
            return unsafe { transmute_copy(&fetch_byte(self.address.as_ptr().cast())) };
        }
        if size_of::<T>() == 2 {
            // SAFETY: as above, with two bytes.
            return unsafe { transmute_copy(&fetch_word(self.address.as_ptr().cast())) };
        }
        let mut copy = MaybeUninit::<T>::uninit();
        // SAFETY: by the contract of `new`, `size_of::<T>()` bytes are readable, and `copy` has room for them. A
        // bitwise copy of a `Copy` value is a valid value.
        unsafe {
            fetch_bytes(
                self.address.as_ptr().cast(),
                copy.as_mut_ptr().cast(),
                size_of::<T>(),
            );
            copy.assume_init()
        }
    }
}

impl<'a, T, const N: usize> Flash<'a, [T; N]> {
    /// The array as a slice, still in flash.
    #[inline]
    pub const fn as_slice(self) -> Flash<'a, [T]> {
        // SAFETY: the slice has the elements and the lifetime of the array.
        unsafe { Flash::new(self.address.as_ptr() as *const [T]) }
    }

    /// The element at `index`, still in flash; past the end, the last one.
    #[inline]
    pub const fn at(self, index: usize) -> Flash<'a, T> {
        const { assert!(N > 0) };
        let index = if index < N { index } else { N - 1 };
        // SAFETY: `index` is less than the length of the array at `self.address`.
        unsafe { Flash::new(self.address.as_ptr().cast::<T>().add(index)) }
    }
}

impl<'a, T> Flash<'a, [T]> {
    /// A slice without elements.
    pub const EMPTY: Self = Self {
        address: NonNull::slice_from_raw_parts(NonNull::dangling(), 0),
        marker: PhantomData,
    };

    /// The number of elements.
    #[inline]
    pub const fn len(self) -> usize {
        self.address.len()
    }

    /// True if the slice is empty.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The element at `index`, still in flash; past the end, the last one; `None` if the slice is empty.
    #[inline]
    pub const fn get(self, index: usize) -> Option<Flash<'a, T>> {
        if self.is_empty() {
            return None;
        }
        let last_index = self.len() - 1;
        let index = if index < last_index {
            index
        } else {
            last_index
        };
        // SAFETY: `index` is less than the length of the slice at `self.address`.
        Some(unsafe { Flash::new(self.address.as_ptr().cast::<T>().add(index)) })
    }

    /// The `length` elements from index `start` on; `None` if there are fewer.
    #[inline]
    pub const fn subslice(self, start: usize, length: usize) -> Option<Flash<'a, [T]>> {
        if start > self.len() || length > self.len() - start {
            return None;
        }
        // SAFETY: `start` is within the slice at `self.address`, or at its end.
        let first = unsafe { self.address.as_ptr().cast::<T>().add(start) };
        let elements = core::ptr::slice_from_raw_parts(first, length);
        // SAFETY: the elements are a part of the slice at `self.address` and have its lifetime.
        Some(unsafe { Flash::new(elements) })
    }
}

impl<'a> Flash<'a, [u8]> {
    /// Reinterprets the bytes as values of a [`Pod`] type; leaves out an incomplete value at the end.
    #[inline]
    pub const fn cast<T: Pod>(self) -> Flash<'a, [T]> {
        let values = core::ptr::slice_from_raw_parts(
            self.address.as_ptr().cast_const().cast::<T>(),
            self.len() / const { require_nonzero(size_of::<T>()) },
        );
        // SAFETY: this many values fit in the bytes, any bit pattern is a valid `Pod` value, and `new` requires no
        // alignment.
        unsafe { Flash::new(values) }
    }

    /// Reads the value whose bytes begin at `offset`. Returns an all-zero value if that value is not entirely within
    /// the slice.
    #[inline]
    pub fn read<T: Pod>(self, offset: usize) -> T {
        match self.subslice(offset, size_of::<T>()) {
            Some(bytes) => {
                // SAFETY: there are `size_of::<T>()` bytes, and any bit pattern is a valid `T`.
                unsafe { Flash::new(bytes.address.as_ptr().cast_const().cast::<T>()) }.load()
            }
            // SAFETY: any bit pattern is a valid `T`, so all zeros are, too.
            None => unsafe { core::mem::zeroed() },
        }
    }
}

const fn require_nonzero(size: usize) -> usize {
    assert!(size > 0);
    size
}

/// Plain old data: a type without padding, for which any bit pattern is a valid value. Its bytes are little-endian, the
/// same in the flash of an AVR and in the memory of a host. See [`pod!`](crate::pod!).
///
/// # Safety
/// Any bit pattern must be a valid value, and no byte may be padding.
pub unsafe trait Pod: Copy {
    /// The value's bytes.
    #[inline]
    fn bytes(&self) -> &[u8] {
        // SAFETY: no byte of the value is padding.
        unsafe { core::slice::from_raw_parts((&raw const *self).cast(), size_of::<Self>()) }
    }
}
// SAFETY: any bit pattern is a valid integer, and an integer has no padding.
unsafe impl Pod for u8 {}
// SAFETY: as above.
unsafe impl Pod for i8 {}
// SAFETY: as above.
unsafe impl Pod for u16 {}
// SAFETY: as above.
unsafe impl Pod for i16 {}
// SAFETY: as above.
unsafe impl Pod for u32 {}
// SAFETY: as above.
unsafe impl Pod for i32 {}
// SAFETY: an array has no padding between its elements.
unsafe impl<T: Pod, const N: usize> Pod for [T; N] {}

// The AVR and all hosts in use are little-endian.
const _: () = assert!(cfg!(target_endian = "little"));

/// Declares a [`Pod`](crate::Pod) struct, whose fields must be `Pod` types in an order that leaves no padding. The
/// compiler checks this.
///
/// ```
/// lizard_avr::pod! {
///     /// A point.
///     #[derive(Debug, PartialEq)]
///     pub struct Point {
///         /// To the right, mm.
///         pub x: i16,
///         /// Forward, mm.
///         pub y: i16,
///     }
/// }
/// let bytes = [0, 1, 2, 0, 255];
/// let flash = lizard_avr::Flash::from(&bytes[..]);
/// assert_eq!(flash.read::<Point>(0), Point { x: 256, y: 2 });
/// ```
#[macro_export]
macro_rules! pod {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident {
            $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $type:ty),* $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy)]
        #[repr(C)]
        $vis struct $name {
            $($(#[$field_meta])* $field_vis $field: $type),*
        }
        $crate::pod!($name: $($type),*);
    };
    ($name:ty: $($type:ty),*) => {
        // SAFETY: all fields are `Pod`, and the assertion below excludes padding between them.
        #[allow(unsafe_code)]
        unsafe impl $crate::Pod for $name {}
        const _: () = {
            const fn pod_size<T: $crate::Pod>() -> usize {
                size_of::<T>()
            }
            assert!(size_of::<$name>() == 0 $(+ pod_size::<$type>())*, "the struct must have no padding");
        };
    };
}

impl<T: ?Sized> core::fmt::Debug for Flash<'_, T> {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        f.write_str("in flash")
    }
}

#[cfg(target_arch = "avr")]
#[inline]
unsafe fn fetch_byte(source: *const u8) -> u8 {
    let byte: u8;
    // SAFETY: the caller guarantees a byte of flash at `source`.
    unsafe {
        core::arch::asm!(
            "lpm {byte}, Z",
            byte = out(reg) byte,
            in("Z") source,
            options(pure, readonly, nostack, preserves_flags),
        );
    }
    byte
}

#[cfg(target_arch = "avr")]
#[inline]
unsafe fn fetch_word(source: *const u8) -> u16 {
    let word: u16;
    // SAFETY: the caller guarantees two bytes of flash at `source`.
    unsafe {
        core::arch::asm!(
            "lpm {word:l}, Z+",
            "lpm {word:h}, Z",
            word = out(reg_pair) word,
            inout("Z") source => _,
            options(pure, readonly, nostack, preserves_flags),
        );
    }
    word
}

#[cfg(target_arch = "avr")]
#[inline(never)]
unsafe fn fetch_bytes(source: *const u8, destination: *mut u8, count: usize) {
    let mut source = source;
    for index in 0..count {
        // SAFETY: the caller guarantees `count` bytes of flash at `source` and of RAM at `destination`.
        unsafe {
            destination.add(index).write(fetch_byte(source));
            source = source.add(1);
        }
    }
}

/// Declares constants that stay in flash.
///
/// ```
/// lizard_avr::flash! {
///     /// Powers of two.
///     pub const POWERS_OF_TWO: [u16; 4] = [1, 2, 4, 8];
/// }
/// assert_eq!(POWERS_OF_TWO.at(2).load(), 4);
/// ```
#[macro_export]
macro_rules! flash {
    ($($(#[$meta:meta])* $vis:vis const $name:ident: $type:ty = $value:expr;)*) => {$(
        $(#[$meta])*
        $vis const $name: $crate::Flash<'static, $type> = {
            // SAFETY: the linker script puts this section of constants into flash.
            #[cfg_attr(target_arch = "avr", unsafe(link_section = ".progmem.data"))]
            static VALUE: $type = $value;
            // SAFETY: `VALUE` is a static, and the attribute puts it into the memory that `new` requires.
            unsafe { $crate::Flash::new(&raw const VALUE) }
        };
    )*};
}
