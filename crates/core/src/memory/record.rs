//! Records in a non-volatile memory that may lose power at any time.
//!
//! An EEPROM writes a byte in 3.4 ms. If power fails during the write, the byte may have any value. Therefore a record
//! has a mark, which is removed before the first byte changes and written again after the last byte. Without the mark
//! the record is invalid. A CRC detects other damage, such as bits that flip over the years.

use crate::numbers::checksum::Checksum;

/// A non-volatile memory.
pub trait Memory {
    /// True once the last write has ended; only then may the memory be read or written.
    fn is_ready(&self) -> bool;

    /// Reads the byte at an address below 1024.
    fn read(&self, address: u16) -> u8;

    /// Starts writing a byte.
    fn write(&mut self, address: u16, byte: u8);
}

/// The number of bytes in a memory.
pub const MEMORY_BYTES: usize = 1024;

/// The number of bytes in a record's content.
pub const CONTENT_BYTES: usize = 42;

// `RecordWrite::advance` selects the byte of the CRC by the parity of the step.
const _: () = assert!(CONTENT_BYTES.is_multiple_of(2));

/// The content of a record.
pub type RecordContent = [u8; CONTENT_BYTES];

/// The number of bytes in a record: the mark, the content and the CRC.
pub const RECORD_BYTES: u16 = CONTENT_BYTES as u16 + 3;

/// The first byte of a valid record.
pub const VALID_MARK: u8 = 0xa5;

/// The first byte of an invalid record, which is the value of an erased byte.
pub const ERASED: u8 = 0xff;

/// The address of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordAddress(pub u16);

/// The state of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordState {
    /// The record has never been written.
    Blank,
    /// The record was invalidated, is incomplete, or has changed since it was written.
    Damaged,
    /// The record's mark and CRC are correct.
    Valid,
}

/// The result of a step of writing a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The write is not complete, or the memory is not ready.
    InProgress,
    /// All bytes have been written and read back.
    Done,
    /// A byte has another value than the one that was written.
    Failed,
}

/// The state of the current step's byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 1, so that `None::<RecordWrite>` is all zeros: see `Main::new`.
#[repr(u8)]
enum ByteState {
    /// The byte must be written, unless the memory already has its value.
    ToWrite = 1,
    /// The byte has been written and must be read back.
    Written,
}

/// A write or an invalidation of a record in progress, one byte at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordWrite {
    address: RecordAddress,
    /// The current step: step 0 removes the mark, each of the next steps writes a byte, and the last step writes the
    /// mark.
    step: u8,
    /// The last step.
    last_step: u8,
    byte_state: ByteState,
}

impl RecordAddress {
    /// Checks the record's mark and CRC.
    #[inline(never)]
    pub fn check<M: Memory>(self, memory: &M) -> RecordState {
        let mut content = [0; CONTENT_BYTES];
        self.read_content(memory, &mut content);
        let crc = [1, 2].map(|n| memory.read(self.0 + CONTENT_BYTES as u16 + n));
        let mark = memory.read(self.0);
        if mark == VALID_MARK && crc == Checksum::compute(&content).0.to_le_bytes() {
            RecordState::Valid
        } else if mark == ERASED && content.iter().chain(&crc).all(|byte| *byte == ERASED) {
            RecordState::Blank
        } else {
            RecordState::Damaged
        }
    }

    /// Reads the content without checking the mark and the CRC.
    #[inline(never)]
    pub fn read_content<M: Memory>(self, memory: &M, content: &mut RecordContent) {
        let mut address = self.0;
        for byte in content {
            address += 1;
            *byte = memory.read(address);
        }
    }

    /// Reads a byte of the content.
    pub fn read_byte<M: Memory>(self, memory: &M, index: u16) -> u8 {
        memory.read(self.0 + 1 + index)
    }

    /// Starts writing a record.
    pub const fn start_write(self) -> RecordWrite {
        RecordWrite {
            address: self,
            step: 0,
            last_step: RECORD_BYTES as u8,
            byte_state: ByteState::ToWrite,
        }
    }

    /// Starts invalidating a record.
    pub const fn start_invalidation(self) -> RecordWrite {
        RecordWrite {
            last_step: 0,
            ..self.start_write()
        }
    }
}

impl RecordWrite {
    /// True if this only invalidates the record.
    pub const fn is_invalidation(&self) -> bool {
        self.last_step == 0
    }

    /// Advances by at most one byte. Does not write a byte that the memory already has. `content` must be the same in
    /// every call.
    #[inline(never)]
    pub fn advance<M: Memory>(&mut self, content: &RecordContent, memory: &mut M) -> Progress {
        if !memory.is_ready() {
            return Progress::InProgress;
        }
        let step = u16::from(self.step);
        let (offset, byte) = if step == 0 {
            (0, ERASED)
        } else if step == RECORD_BYTES {
            (0, VALID_MARK)
        } else {
            let crc_byte =
                || Checksum::compute(content).0.to_le_bytes()[usize::from(self.step & 1 ^ 1)];
            let byte = content.get(usize::from(self.step - 1));
            (step, byte.copied().unwrap_or_else(crc_byte))
        };
        let address = self.address.0 + offset;
        if memory.read(address) != byte {
            if self.byte_state == ByteState::Written {
                return Progress::Failed;
            }
            self.byte_state = ByteState::Written;
            memory.write(address, byte);
        } else if self.step == self.last_step {
            return Progress::Done;
        } else {
            self.step += 1;
            self.byte_state = ByteState::ToWrite;
        }
        Progress::InProgress
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use crc::{CRC_16_IBM_3740, Crc};
    use proptest::prelude::*;

    use super::*;
    use crate::virtual_board::Eeprom;

    const ADDRESS: RecordAddress = RecordAddress(64);

    fn any_content() -> impl Strategy<Value = RecordContent> {
        prop::collection::vec(any::<u8>(), CONTENT_BYTES)
            .prop_map(|bytes| RecordContent::try_from(bytes).expect("the length is fixed"))
    }

    impl RecordWrite {
        /// Writes all remaining bytes.
        pub(crate) fn complete(mut self, content: &RecordContent, eeprom: &mut Eeprom) -> Progress {
            for _ in 0..10_000 {
                match self.advance(content, eeprom) {
                    Progress::InProgress => {}
                    result => return result,
                }
            }
            panic!("the write never ends");
        }
    }

    /// Writes a complete record.
    fn write_record(eeprom: &mut Eeprom, content: &RecordContent) -> Progress {
        ADDRESS.start_write().complete(content, eeprom)
    }

    /// Reads a record's state, and its content even if the record is not valid.
    fn read_record(eeprom: &Eeprom) -> (RecordState, RecordContent) {
        let mut content = [0; CONTENT_BYTES];
        ADDRESS.read_content(eeprom, &mut content);
        (ADDRESS.check(eeprom), content)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn a_record_reads_back_unchanged_and_no_other_byte_changes(
            first_content in any_content(),
            second_content in any_content(),
            write_delay in 0u16..4,
        ) {
            let mut eeprom = Eeprom::blank();
            eeprom.write_delay = write_delay;
            prop_assert_eq!(read_record(&Eeprom::blank()).0, RecordState::Blank);
            for content in [first_content, second_content] {
                prop_assert_eq!(write_record(&mut eeprom, &content), Progress::Done);
                eeprom.write_delay = 0;
                let eeprom = Eeprom::with_bytes(*eeprom.bytes());
                prop_assert_eq!(read_record(&eeprom), (RecordState::Valid, content));
            }
            let is_outside = |address: &usize| !(64..64 + usize::from(RECORD_BYTES)).contains(address);
            prop_assert!((0..1024).filter(is_outside).all(|address| eeprom.bytes()[address] == ERASED));
        }

        #[test]
        fn the_crc_is_crc_16_ibm_3740(content in any_content()) {
            let mut eeprom = Eeprom::blank();
            write_record(&mut eeprom, &content);
            let crc = Crc::<u16>::new(&CRC_16_IBM_3740).checksum(&content);
            prop_assert_eq!(&eeprom.bytes()[64 + 43..][..2], &crc.to_le_bytes());
        }
    }

    #[test]
    fn rewriting_changes_only_the_mark_and_the_bytes_that_differ() {
        let mut eeprom = Eeprom::blank();
        let mut content = [7; CONTENT_BYTES];
        write_record(&mut eeprom, &content);
        eeprom.log.clear();
        write_record(&mut eeprom, &content);
        let mark_writes = [(64, VALID_MARK, ERASED), (64, ERASED, VALID_MARK)];
        assert_eq!(eeprom.log, mark_writes);
        eeprom.log.clear();
        content[5] = 8;
        write_record(&mut eeprom, &content);
        let addresses: Vec<u16> = eeprom.log.iter().map(|(address, ..)| *address).collect();
        assert_eq!(addresses[..2], [64, 64 + 6]);
        assert_eq!(addresses.last(), Some(&64));
        let claim = "the mark is written twice, otherwise only byte 5 and the CRC";
        assert!((4..=5).contains(&addresses.len()), "{claim}");
    }

    #[test]
    fn a_worn_memory_is_detected() {
        let mut eeprom = Eeprom::blank();
        eeprom.is_worn = true;
        let progress = write_record(&mut eeprom, &[1; CONTENT_BYTES]);
        assert_eq!(progress, Progress::Failed);
    }

    #[test]
    fn an_invalidated_record_is_damaged_and_keeps_its_content() {
        let mut eeprom = Eeprom::blank();
        write_record(&mut eeprom, &[3; CONTENT_BYTES]);
        let bytes_before = *eeprom.bytes();
        let record_write = ADDRESS.start_invalidation();
        record_write.complete(&[0; CONTENT_BYTES], &mut eeprom);
        assert_eq!(read_record(&eeprom).0, RecordState::Damaged);
        assert_eq!(eeprom.bytes()[64], ERASED);
        assert_eq!(eeprom.bytes()[65..], bytes_before[65..]);
    }
}
