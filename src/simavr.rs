//! The note in the ELF file that tells stock simavr the chip, the clock and the voltages. It is not
//! part of the flash. Without the note, simavr assumes a supply of 3.3 V, at which the firmware moves no servo.

/// Returns a tag of simavr's `avr_mcu_section.h` with a number of 32 bits.
const fn number(tag: u8, value: u32) -> [u8; 6] {
    let [a, b, c, d] = value.to_le_bytes();
    [tag, 4, a, b, c, d]
}

/// Length of the chip's name, padded with zeros, in bytes.
const NAME_BYTES: usize = 64;

#[repr(C)]
struct Simavr {
    name: [u8; 2 + NAME_BYTES],
    numbers: [[u8; 6]; 4],
    end: [u8; 2],
}

/// The note: tags 1 to 5 for name, clock in Hz, VCC, AVCC and AREF in mV, then the end tag 0.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".mmcu")]
static SIMAVR: Simavr = Simavr {
    name: {
        let mut name = [0; 2 + NAME_BYTES];
        let (head, text) = name.split_at_mut(2);
        head.copy_from_slice(&[1, NAME_BYTES as u8]);
        text.split_at_mut(10).0.copy_from_slice(b"atmega328p");
        name
    },
    numbers: [
        number(2, 16_000_000),
        number(3, 5000),
        number(4, 5000),
        number(5, 5000),
    ],
    end: [0; 2],
};
