//! The section `.mmcu` of the ELF file, which tells an unmodified simavr the chip, the clock and the voltages. It is
//! not in flash. Without it, simavr assumes a supply of 3.3 V, at which the firmware moves no servo.

/// Makes a number's record as in simavr's `avr_mcu_section.h`: tag, length and 32-bit number.
const fn make_number_record(tag: u8, value: u32) -> [u8; 6] {
    let [a, b, c, d] = value.to_le_bytes();
    [tag, 4, a, b, c, d]
}

/// Bytes of the chip's name, including the zeros that pad it.
const NAME_BYTES: usize = 64;

/// The layout of the section: records of tag, length and value.
#[repr(C)]
struct Mmcu {
    name_record: [u8; 2 + NAME_BYTES],
    number_records: [[u8; 6]; 4],
    end_record: [u8; 2],
}

/// The section, with the tags 1 to 5 for the name, the clock in Hz, and VCC, AVCC and AREF in mV, followed by the end
/// tag 0.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".mmcu")]
static MMCU: Mmcu = Mmcu {
    name_record: {
        let mut record = [0; 2 + NAME_BYTES];
        let (header, text) = record.split_at_mut(2);
        header.copy_from_slice(&[1, NAME_BYTES as u8]);
        text.split_at_mut(10).0.copy_from_slice(b"atmega328p");
        record
    },
    number_records: [
        make_number_record(2, 16_000_000),
        make_number_record(3, 5000),
        make_number_record(4, 5000),
        make_number_record(5, 5000),
    ],
    end_record: [0; 2],
};
