//! Sealing a section: adding its length and its checksum.
//!
//! A 16-bit checksum misses one change in 65 536. Two kinds of change are likely: a write that ended early, at any of
//! thousands of bytes, so that erased flash follows the written bytes; and a flipped bit of the length. Neither may
//! be missed. So `add_seal` tries all of them, and adds a byte if the checksum would miss one.

use core::mem::offset_of;
use std::vec::Vec;

use super::{CRC_COVERS_FROM, Header, SPACE};
use crate::numbers::checksum::Checksum;

/// A byte of erased flash.
const ERASED: u8 = 0xff;

/// The offset of the length.
const LENGTH_OFFSET: usize = offset_of!(Header, length);
/// The offset of the checksum, which covers all bytes after it.
const CRC_OFFSET: usize = offset_of!(Header, crc);

/// Writes the correct checksum into a section, whether its content is valid or not.
///
/// # Panics
/// If the section is shorter than a header.
pub fn seal(section: &mut [u8]) {
    let crc = Checksum::of(&section[CRC_COVERS_FROM..]).0;
    section[CRC_OFFSET..CRC_COVERS_FROM].copy_from_slice(&crc.to_le_bytes());
}

/// Adds length and checksum to a section. Appends bytes until the checksum detects every write that ended early and
/// every flipped bit of the length.
///
/// # Panics
/// If the section is longer than 65 535 bytes.
pub(super) fn add_seal(mut section: Vec<u8>) -> Vec<u8> {
    loop {
        let length = u16::try_from(section.len()).expect("at most 65535");
        section[LENGTH_OFFSET..CRC_OFFSET].copy_from_slice(&length.to_le_bytes());
        seal(&mut section);
        let checked = &section[CRC_COVERS_FROM..];
        let sums = sums_of_prefixes(checked);
        if !has_undetected_prefix(checked, &sums) && !has_undetected_length(length, &sums) {
            return section;
        }
        section.push(0);
    }
}

/// The checksums of all prefixes of a section, from none of its bytes to all of them.
fn sums_of_prefixes(bytes: &[u8]) -> Vec<Checksum> {
    let mut sum = Checksum::EMPTY;
    let mut sums = Vec::with_capacity(bytes.len() + 1);
    sums.push(sum);
    for byte in bytes {
        sum = sum.with_byte(*byte);
        sums.push(sum);
    }
    sums
}

/// True if a proper prefix of the bytes, followed by erased flash, has the checksum of all of them. Bytes at the end
/// that equal erased flash do not count, since losing them changes nothing.
fn has_undetected_prefix(bytes: &[u8], sums: &[Checksum]) -> bool {
    // The checksum that a prefix must have so that the erased bytes after it give the checksum of all bytes.
    let mut needed = sums[bytes.len()];
    let mut is_tail_erased = true;
    for (byte, prefix_sum) in bytes.iter().zip(&sums[..bytes.len()]).rev() {
        needed = without_last_byte(needed, ERASED);
        is_tail_erased &= *byte == ERASED;
        if !is_tail_erased && *prefix_sum == needed {
            return true;
        }
    }
    false
}

/// The checksum before `byte` was added: the inverse of [`Checksum::with_byte`].
const fn without_last_byte(sum: Checksum, byte: u8) -> Checksum {
    // The low half follows only from the previous high half and the byte.
    let low = sum.0 as u8;
    let out = low ^ (low << 5);
    let high = out ^ (out >> 4) ^ byte;
    let out = out as u16;
    let low = (sum.0 ^ (out << 12) ^ (out << 5) ^ out) >> 8;
    Checksum((high as u16) << 8 | low)
}

/// True if a length with one flipped bit gives the same checksum, with erased flash after the section. No board
/// accepts more than [`SPACE`] bytes.
fn has_undetected_length(length: u16, sums: &[Checksum]) -> bool {
    let own_sum = sums[usize::from(length) - CRC_COVERS_FROM];
    let is_one_off = |other_length: u16| (other_length ^ length).is_power_of_two();
    let has_shorter = (CRC_COVERS_FROM as u16 + 1..length).any(|other_length| {
        is_one_off(other_length) && sums[usize::from(other_length) - CRC_COVERS_FROM] == own_sum
    });
    let mut sum = own_sum;
    has_shorter
        || (length..SPACE).any(|last| {
            sum = sum.with_byte(ERASED);
            is_one_off(last + 1) && sum == own_sum
        })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Reference for [`has_undetected_prefix`]: computes the checksum of each cut section anew.
    fn has_prefix_with_sum(bytes: &[u8]) -> bool {
        let sum = Checksum::of(bytes);
        (0..bytes.len()).any(|end| {
            let mut cut = bytes.to_vec();
            cut[end..].fill(ERASED);
            cut != bytes && Checksum::of(&cut) == sum
        })
    }

    /// Reference for [`has_undetected_length`], on the bytes that the flash would hold.
    fn has_other_length_with_sum(section: &[u8]) -> bool {
        let sum = Checksum::of(&section[CRC_COVERS_FROM..]);
        let mut flash = section.to_vec();
        flash.resize(SPACE.into(), ERASED);
        let lengths = (0..16).map(|bit| section.len() ^ 1 << bit);
        let mut lengths =
            lengths.filter(|length| (CRC_COVERS_FROM + 1..=flash.len()).contains(length));
        lengths.any(|length| Checksum::of(&flash[CRC_COVERS_FROM..length]) == sum)
    }

    /// Finds the two bytes that change one checksum into another.
    fn bytes_between(from: Checksum, to: Checksum) -> [u8; 2] {
        let pairs = (0..=u16::MAX).map(u16::to_le_bytes);
        let mut matching = pairs.filter(|[low, high]| from.with_byte(*low).with_byte(*high) == to);
        matching.next().expect("any two sums are two bytes apart")
    }

    #[test]
    fn every_byte_of_a_sum_can_be_taken_back() {
        for sum in (0..=u16::MAX).map(Checksum) {
            for byte in 0..=u8::MAX {
                assert_eq!(without_last_byte(sum.with_byte(byte), byte), sum);
            }
        }
    }

    #[test]
    fn a_length_one_bit_off_that_has_the_sum_is_found() {
        let mut counts = [0, 0];
        for length in [300usize, 425] {
            for bit in 0..8 {
                let other_length = length ^ 1 << bit;
                let mut bytes: Vec<u8> = (0..length as u32 - 2)
                    .map(|n| ((n * n) >> 3) as u8)
                    .collect();
                if other_length <= CRC_COVERS_FROM
                    || (bytes.len() + 1..length).contains(&other_length)
                {
                    continue;
                }
                // For a shorter length, the checksum at that length; for a longer one, a checksum that the erased
                // bytes do not change.
                let add_erased = |start| {
                    (length..other_length).fold(start, |sum: Checksum, _| sum.with_byte(ERASED))
                };
                let target = match other_length < length {
                    true => Some(Checksum::of(&bytes[CRC_COVERS_FROM..other_length])),
                    false => (0..=u16::MAX)
                        .map(Checksum)
                        .find(|sum| add_erased(*sum) == *sum),
                };
                let Some(target) = target else { continue };
                bytes.extend(bytes_between(
                    Checksum::of(&bytes[CRC_COVERS_FROM..]),
                    target,
                ));
                assert!(
                    has_other_length_with_sum(&bytes),
                    "{length} and {other_length}"
                );
                let sums = sums_of_prefixes(&bytes[CRC_COVERS_FROM..]);
                assert!(
                    has_undetected_length(length as u16, &sums),
                    "{length} and {other_length}"
                );
                counts[usize::from(other_length > length)] += 1;
            }
        }
        let [shorter, longer] = counts;
        assert!(
            shorter >= 6 && longer >= 6,
            "{shorter} shorter, {longer} longer"
        );
    }

    proptest! {
        #[test]
        fn a_beginning_that_has_the_sum_of_all_is_found(
            bytes in prop::collection::vec(any::<u8>(), 0..300),
            erased_count in 0..4usize,
            end in 0..300usize,
        ) {
            let mut bytes = bytes;
            bytes.extend(std::vec![ERASED; erased_count]);
            prop_assert_eq!(has_undetected_prefix(&bytes, &sums_of_prefixes(&bytes)), has_prefix_with_sum(&bytes));
            // Two more bytes can always be chosen so that this beginning has the checksum of all bytes.
            let end = end.min(bytes.len());
            let mut cut = bytes.clone();
            cut[end..].fill(ERASED);
            let target = Checksum::of(&cut).with_byte(ERASED).with_byte(ERASED);
            bytes.extend(bytes_between(Checksum::of(&bytes), target));
            prop_assert_eq!(has_undetected_prefix(&bytes, &sums_of_prefixes(&bytes)), has_prefix_with_sum(&bytes));
            let differs = cut[end..].iter().chain(&[ERASED; 2]).ne(&bytes[end..]);
            prop_assert_eq!(has_undetected_prefix(&bytes, &sums_of_prefixes(&bytes)), differs || has_prefix_with_sum(&bytes));
        }

        #[test]
        fn a_sealed_section_has_its_length_and_sum_and_at_most_some_bytes_more(
            bytes in prop::collection::vec(any::<u8>(), CRC_COVERS_FROM..600),
        ) {
            let section = add_seal(bytes.clone());
            let length = u16::from_le_bytes([section[LENGTH_OFFSET], section[LENGTH_OFFSET + 1]]);
            let crc = u16::from_le_bytes([section[CRC_OFFSET], section[CRC_OFFSET + 1]]);
            prop_assert_eq!(usize::from(length), section.len());
            prop_assert_eq!(crc, Checksum::of(&section[CRC_COVERS_FROM..]).0);
            prop_assert!(section.len() <= bytes.len() + 3);
            prop_assert!(!has_prefix_with_sum(&section[CRC_COVERS_FROM..]));
            prop_assert!(!has_other_length_with_sum(&section));
            prop_assert_eq!(&section[CRC_COVERS_FROM..bytes.len()], &bytes[CRC_COVERS_FROM..]);
        }
    }
}
