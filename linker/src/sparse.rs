//! Static data that is zero but for a few bytes.
//!
//! An initialised variable is in flash byte for byte, zeros too, and startup code copies
//! it to RAM. A cleared variable costs nothing. So a variable that is nearly all zero is
//! cleared with the others (`.bss`), and a loop writes the other bytes right afterwards,
//! before `main` and before any constructor: `.init5` of avr-libc's startup, while
//! interrupts are off and r1 is zero.

use object::build::elf::SymbolId;
use object::elf;

use crate::edit::Reference;

/// Bytes of the loop.
const LOOP: usize = 22;

/// Bytes that a table may have: its end is known by the lower half of its address.
const TABLE: usize = 254;

/// The table from which the loop writes a variable: how many bytes farther than the one
/// before, the first from the beginning, and what. None if nothing is gained by it.
pub fn table(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut table = Vec::new();
    let mut place = 0;
    for (at, byte) in bytes.iter().enumerate().filter(|(_, byte)| **byte != 0) {
        while at - place > 255 {
            place += 255;
            // What is written on the way is the zero that is there.
            table.extend([255, bytes[place]]);
        }
        table.extend([(at - place) as u8, *byte]);
        place = at;
    }
    let is_worth_it = table.len() + LOOP < bytes.len();
    (is_worth_it && !table.is_empty() && table.len() <= TABLE).then_some(table)
}

/// The loop's code, and what it refers to: the variable `symbol + addend`, and a table of so
/// many bytes.
pub fn code(variable: (SymbolId, i64), table: (SymbolId, usize)) -> (Vec<u16>, Vec<Reference>) {
    let code = vec![
        0xe0a0, // ldi r26, lo8(variable)
        0xe0b0, // ldi r27, hi8(variable)
        0xe0e0, // ldi r30, lo8(table)
        0xe0f0, // ldi r31, hi8(table)
        0x9185, // 1: lpm r24, Z+
        0x0fa8, // add r26, r24
        0x1db1, // adc r27, r1
        0x9005, // lpm r0, Z+
        0x920c, // st X, r0
        0x30e0, // cpi r30, lo8(behind the table)
        0xf7c9, // brne 1b
    ];
    let reference = |index: u64, kind, (symbol, addend)| Reference {
        offset: 2 * index,
        kind,
        symbol,
        addend,
    };
    let begin = (table.0, 0);
    let end = (table.0, table.1 as i64);
    let references = vec![
        reference(0, elf::R_AVR_LO8_LDI, variable),
        reference(1, elf::R_AVR_HI8_LDI, variable),
        reference(2, elf::R_AVR_LO8_LDI, begin),
        reference(3, elf::R_AVR_HI8_LDI, begin),
        reference(9, elf::R_AVR_LO8_LDI, end),
    ];
    (code, references)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the loop leaves of cleared memory.
    fn written(table: &[u8], size: usize) -> Vec<u8> {
        let mut memory = vec![0; size];
        let mut place = 0;
        for pair in table.chunks(2) {
            place += usize::from(pair[0]);
            memory[place] = pair[1];
        }
        memory
    }

    #[test]
    fn a_table_writes_every_byte_that_is_not_zero_wherever_it_is() {
        for places in [
            vec![0],
            vec![255],
            vec![256],
            vec![511, 512],
            vec![0, 255, 510, 999],
        ] {
            let mut bytes = vec![0; 1000];
            for place in places {
                bytes[place] = (place % 255) as u8 + 1;
            }
            let table = table(&bytes).expect("it is shorter than a thousand bytes");
            assert_eq!(written(&table, 1000), bytes);
        }
    }

    #[test]
    fn what_is_zero_altogether_or_nowhere_has_no_table() {
        assert_eq!(table(&[0; 300]), None, "it is cleared without this");
        assert_eq!(table(&[1; 300]), None, "the table would be longer");
        assert_eq!(table(&[0, 1]), None, "the loop would be longer");
    }

    #[test]
    fn a_table_whose_end_its_address_does_not_tell_is_not_made() {
        let mut bytes = vec![0; 1000];
        bytes[..127].fill(1);
        assert_eq!(table(&bytes).map(|table| table.len()), Some(254));
        bytes[..128].fill(1);
        assert_eq!(table(&bytes), None);
    }
}
