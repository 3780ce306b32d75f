//! Sealing a section: adding its length and its checksum.
//!
//! A 16-bit checksum misses one change in 65 536. Two kinds of changes are likely: a write that ended early, at any of
//! thousands of bytes, so that erased flash follows the written bytes; and a flipped bit of the length. The checksum
//! must detect all these changes. Therefore `add_seal` tests all of them, and appends bytes until the checksum misses
//! none.

use core::mem::offset_of;
use std::vec::Vec;

use super::{CHECKED_START, Header, REGION_BYTES};
use crate::numbers::checksum::Checksum;

/// A byte of erased flash.
const ERASED_BYTE: u8 = 0xff;

/// The offset of the length in the header.
const LENGTH_OFFSET: usize = offset_of!(Header, length);
/// The offset of the checksum in the header; the checksum covers all bytes after itself.
const CHECKSUM_OFFSET: usize = offset_of!(Header, crc);

/// Writes the correct checksum into a section, whether its content is valid or not.
///
/// # Panics
/// Panics if the section is shorter than a header.
pub fn write_checksum(section: &mut [u8]) {
    let checksum = Checksum::compute(&section[CHECKED_START..]).0;
    section[CHECKSUM_OFFSET..CHECKED_START].copy_from_slice(&checksum.to_le_bytes());
}

/// Adds the length and the checksum to a section. Appends bytes until the checksum detects every write that ended early
/// and every flipped bit of the length.
///
/// # Panics
/// Panics if the section is longer than 65 535 bytes.
pub(super) fn add_seal(mut section: Vec<u8>) -> Vec<u8> {
    loop {
        let length = u16::try_from(section.len()).expect("a section has at most 65535 bytes");
        section[LENGTH_OFFSET..CHECKSUM_OFFSET].copy_from_slice(&length.to_le_bytes());
        write_checksum(&mut section);
        let checked_bytes = &section[CHECKED_START..];
        let checksums = compute_prefix_checksums(checked_bytes);
        if !has_undetected_prefix(checked_bytes, &checksums)
            && !has_undetected_length(length, &checksums)
        {
            return section;
        }
        section.push(0);
    }
}

/// Computes the checksums of all prefixes of the bytes, from the empty prefix to all bytes.
fn compute_prefix_checksums(bytes: &[u8]) -> Vec<Checksum> {
    let mut checksum = Checksum::EMPTY;
    let mut prefix_checksums = Vec::with_capacity(bytes.len() + 1);
    prefix_checksums.push(checksum);
    for byte in bytes {
        checksum = checksum.with_byte(*byte);
        prefix_checksums.push(checksum);
    }
    prefix_checksums
}

/// True if a proper prefix of the bytes, followed by erased flash, has the checksum of all bytes. Ignores a prefix if
/// all bytes after it equal erased flash, because a write that ends there leaves the same bytes.
fn has_undetected_prefix(bytes: &[u8], prefix_checksums: &[Checksum]) -> bool {
    // A prefix with this checksum, followed by erased bytes, has the checksum of all bytes.
    let mut needed_checksum = prefix_checksums[bytes.len()];
    let mut is_tail_erased = true;
    for (byte, prefix_checksum) in bytes.iter().zip(&prefix_checksums[..bytes.len()]).rev() {
        needed_checksum = without_last_byte(needed_checksum, ERASED_BYTE);
        is_tail_erased &= *byte == ERASED_BYTE;
        if !is_tail_erased && *prefix_checksum == needed_checksum {
            return true;
        }
    }
    false
}

/// Returns the checksum before `byte` was added, which is the inverse of [`Checksum::with_byte`].
const fn without_last_byte(checksum: Checksum, byte: u8) -> Checksum {
    // The low half depends only on the previous high half and the byte.
    let low = checksum.0 as u8;
    let feedback = low ^ (low << 5);
    let previous_high = feedback ^ (feedback >> 4) ^ byte;
    let feedback = feedback as u16;
    let previous_low = (checksum.0 ^ (feedback << 12) ^ (feedback << 5) ^ feedback) >> 8;
    Checksum((previous_high as u16) << 8 | previous_low)
}

/// True if the checksum is the same for the section's length with one flipped bit. Erased flash follows the section,
/// and a board accepts at most [`REGION_BYTES`] bytes.
fn has_undetected_length(length: u16, prefix_checksums: &[Checksum]) -> bool {
    let section_checksum = prefix_checksums[usize::from(length) - CHECKED_START];
    let differs_by_one_bit = |other_length: u16| (other_length ^ length).is_power_of_two();
    let has_undetected_shorter_length = (CHECKED_START as u16 + 1..length).any(|other_length| {
        differs_by_one_bit(other_length)
            && prefix_checksums[usize::from(other_length) - CHECKED_START] == section_checksum
    });
    let mut checksum = section_checksum;
    has_undetected_shorter_length
        || (length..REGION_BYTES).any(|last_index| {
            checksum = checksum.with_byte(ERASED_BYTE);
            differs_by_one_bit(last_index + 1) && checksum == section_checksum
        })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The reference implementation of [`has_undetected_prefix`], which computes the checksum of each cut section from
    /// its first byte on.
    fn has_undetected_prefix_by_definition(bytes: &[u8]) -> bool {
        let checksum = Checksum::compute(bytes);
        (0..bytes.len()).any(|end| {
            let mut cut_bytes = bytes.to_vec();
            cut_bytes[end..].fill(ERASED_BYTE);
            cut_bytes != bytes && Checksum::compute(&cut_bytes) == checksum
        })
    }

    /// The reference implementation of [`has_undetected_length`], which computes the checksums from the bytes in flash.
    fn has_undetected_length_by_definition(section: &[u8]) -> bool {
        let checksum = Checksum::compute(&section[CHECKED_START..]);
        let mut flash = section.to_vec();
        flash.resize(REGION_BYTES.into(), ERASED_BYTE);
        let lengths = (0..16).map(|bit| section.len() ^ 1 << bit);
        let mut lengths =
            lengths.filter(|length| (CHECKED_START + 1..=flash.len()).contains(length));
        lengths.any(|length| Checksum::compute(&flash[CHECKED_START..length]) == checksum)
    }

    /// Finds the two bytes that change the checksum `from` to `to`.
    fn find_bytes_that_change(from: Checksum, to: Checksum) -> [u8; 2] {
        let mut pairs = (0..=u16::MAX).map(u16::to_le_bytes);
        let pair = pairs.find(|[low, high]| from.with_byte(*low).with_byte(*high) == to);
        pair.expect("two bytes can change any checksum to any other")
    }

    #[test]
    fn removing_a_byte_inverts_adding_it() {
        for checksum in (0..=u16::MAX).map(Checksum) {
            for byte in 0..=u8::MAX {
                assert_eq!(without_last_byte(checksum.with_byte(byte), byte), checksum);
            }
        }
    }

    #[test]
    fn a_length_with_one_flipped_bit_and_the_same_checksum_is_found() {
        let mut counts = [0, 0];
        for length in [300usize, 425] {
            for bit in 0..8 {
                let other_length = length ^ 1 << bit;
                let mut bytes: Vec<u8> = (0..length as u32 - 2)
                    .map(|n| ((n * n) >> 3) as u8)
                    .collect();
                if other_length <= CHECKED_START
                    || (bytes.len() + 1..length).contains(&other_length)
                {
                    continue;
                }
                // The target is, for a shorter length, the checksum at that length; for a longer length, a checksum
                // that the erased bytes do not change.
                let add_erased = |start: Checksum| {
                    let added_bytes = length..other_length;
                    added_bytes.fold(start, |checksum, _| checksum.with_byte(ERASED_BYTE))
                };
                let target = match other_length < length {
                    true => Some(Checksum::compute(&bytes[CHECKED_START..other_length])),
                    false => (0..=u16::MAX)
                        .map(Checksum)
                        .find(|checksum| add_erased(*checksum) == *checksum),
                };
                let Some(target) = target else { continue };
                let checksum = Checksum::compute(&bytes[CHECKED_START..]);
                bytes.extend(find_bytes_that_change(checksum, target));
                let case = std::format!("{length} and {other_length}");
                assert!(has_undetected_length_by_definition(&bytes), "{case}");
                let checksums = compute_prefix_checksums(&bytes[CHECKED_START..]);
                assert!(has_undetected_length(length as u16, &checksums), "{case}");
                counts[usize::from(other_length > length)] += 1;
            }
        }
        let [shorter, longer] = counts;
        let are_enough = shorter >= 6 && longer >= 6;
        assert!(are_enough, "{shorter} shorter, {longer} longer");
    }

    proptest! {
        #[test]
        fn a_prefix_with_the_checksum_of_all_bytes_is_found(
            bytes in prop::collection::vec(any::<u8>(), 0..300),
            erased_count in 0..4usize,
            end in 0..300usize,
        ) {
            let has_undetected = |bytes: &[u8]| has_undetected_prefix(bytes, &compute_prefix_checksums(bytes));
            let mut bytes = bytes;
            bytes.extend(std::vec![ERASED_BYTE; erased_count]);
            prop_assert_eq!(has_undetected(&bytes), has_undetected_prefix_by_definition(&bytes));
            // Two more bytes are chosen such that this prefix has the checksum of all bytes.
            let end = end.min(bytes.len());
            let mut cut_bytes = bytes.clone();
            cut_bytes[end..].fill(ERASED_BYTE);
            let target = Checksum::compute(&cut_bytes).with_byte(ERASED_BYTE).with_byte(ERASED_BYTE);
            bytes.extend(find_bytes_that_change(Checksum::compute(&bytes), target));
            prop_assert_eq!(has_undetected(&bytes), has_undetected_prefix_by_definition(&bytes));
            let differs_from_cut = cut_bytes[end..].iter().chain(&[ERASED_BYTE; 2]).ne(&bytes[end..]);
            prop_assert_eq!(has_undetected(&bytes), differs_from_cut || has_undetected_prefix_by_definition(&bytes));
        }

        #[test]
        fn a_sealed_section_has_its_length_and_checksum_and_at_most_three_more_bytes(
            bytes in prop::collection::vec(any::<u8>(), CHECKED_START..600),
        ) {
            let section = add_seal(bytes.clone());
            let length = u16::from_le_bytes([section[LENGTH_OFFSET], section[LENGTH_OFFSET + 1]]);
            let checksum = u16::from_le_bytes([section[CHECKSUM_OFFSET], section[CHECKSUM_OFFSET + 1]]);
            prop_assert_eq!(usize::from(length), section.len());
            prop_assert_eq!(checksum, Checksum::compute(&section[CHECKED_START..]).0);
            prop_assert!(section.len() <= bytes.len() + 3);
            prop_assert!(!has_undetected_prefix_by_definition(&section[CHECKED_START..]));
            prop_assert!(!has_undetected_length_by_definition(&section));
            prop_assert_eq!(&section[CHECKED_START..bytes.len()], &bytes[CHECKED_START..]);
        }
    }
}
