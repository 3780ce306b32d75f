//! The checksum of all stored data: the 16-bit CRC with the polynomial x^16 + x^12 + x^5 + 1 and all ones as its
//! initial value (CRC-16/IBM-3740).
//!
//! The CRC detects every change of one or two bits within 32 751 bits, every change of an odd number of bits, and all
//! changes within sixteen neighbouring bits; it misses one in 65 536 of all other changes. The `crc` crate, the
//! reference of the tests, would require six times the flash.

/// The checksum of the bytes added so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checksum(pub u16);

impl Checksum {
    /// The checksum of no bytes.
    pub const EMPTY: Self = Self(u16::MAX);

    /// Returns the checksum after another byte.
    #[cfg_attr(target_arch = "avr", inline(never))] // so that flash holds it once
    pub const fn with_byte(self, byte: u8) -> Self {
        // Processes all eight bits at once: XORs the byte with the high half of the sum, and feeds the bits shifted out
        // back at the powers of the polynomial.
        let feedback = (self.0 >> 8) as u8 ^ byte;
        let feedback = (feedback ^ (feedback >> 4)) as u16;
        Self((self.0 << 8) ^ (feedback << 12) ^ (feedback << 5) ^ feedback)
    }

    /// Computes the checksum of `bytes`.
    #[inline(never)]
    pub fn compute(bytes: &[u8]) -> Self {
        let mut sum = Self::EMPTY;
        for byte in bytes {
            sum = sum.with_byte(*byte);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use crc::{CRC_16_IBM_3740, Crc};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_checksum_matches_the_crc_catalogue(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let catalogue = Crc::<u16>::new(&CRC_16_IBM_3740);
            prop_assert_eq!(Checksum::compute(&bytes).0, catalogue.checksum(&bytes));
        }
    }
}
