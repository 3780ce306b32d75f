//! Prologues and epilogues of functions, and the calls of shared routines that replace them.
//!
//! A prologue pushes registers, from the lowest to r29, and may make room below them:
//!
//! ```text
//! push r14 .. push r29          ldi r26, 5
//! in r28, SPL                   rcall __frame_save_14
//! in r29, SPH
//! sbiw r28, 5
//! in r0, SREG
//! cli
//! out SPH, r29
//! out SREG, r0
//! out SPL, r28
//! ```
//!
//! An epilogue removes the room, pops the registers in reverse order, and returns (`ret`).
//!
//! The routines also change r26, r0 and the flags. By the calling convention of avr-gcc and LLVM a
//! caller relies on none of these after a call and passes nothing in them: arguments are in
//! r8 to r25 and on the stack, results in r18 to r25. With LLVM's `-enable-ipra` a caller may rely on
//! any register that its callee happens not to change, so it must never be combined with this
//! program. A test reads the flags in .cargo/config.toml.
//!
//! There are routines only for a few lists of registers. If a function pushes exactly one of
//! these lists, the layout of the stack is unchanged at each point of its body. Otherwise the routine
//! pushes more registers, so that the arguments on the stack, which fit into no register, are farther
//! above the variables than the body assumes. Such a routine is used only if the body does not depend
//! on the distance. That is so if the body
//!
//! - never uses an address on the stack, because it has no variables on the stack and does not use the
//!   stack pointer; or
//! - uses only addresses of variables, whose distances from r28 are unchanged. The body reads
//!   and writes by Y+q within the room for the variables, or copies r28 and at once adds a distance within
//!   that room; and it uses r28 and r29 for nothing else. LLVM computes every address on the
//!   stack from r28, so each access to an argument has a distance beyond the room.

use object::build::elf::SymbolId;
use object::elf;

use crate::code::Code;
use crate::edit::{Edit, Reference};
use crate::instruction::{
    CALL, JMP, READ_STACK_POINTER, RET, RETI, WRITE_STACK_POINTER, accesses_stack_pointer,
    encode_ldi_r26, may_use_frame_pointer, popped_register, pushed_register,
};

/// The call-saved registers, in the order in which they are pushed.
const CALL_SAVED: [u8; 18] = [
    2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 28, 29,
];

/// The lowest register that each pair of routines saves and restores.
pub const FIRST_REGISTERS: [u8; 9] = [2, 4, 6, 8, 10, 12, 14, 16, 18];

/// The two routines for one of [`FIRST_REGISTERS`].
#[derive(Debug, Clone, Copy)]
pub struct Routines {
    /// `__frame_save_K`.
    pub save: SymbolId,
    /// `__frame_restore_K`.
    pub restore: SymbolId,
}

/// The stack frame of a function that has one of the known forms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// The index in [`FIRST_REGISTERS`] of the routine that saves all registers of the function.
    pub first: usize,
    /// The size of the variables, bytes.
    pub room: u8,
    /// The size of the prologue, bytes.
    pub prologue_size: u64,
    /// The offset and the size of each epilogue.
    pub epilogues: Vec<(u64, u64)>,
}

impl Frame {
    /// Recognizes the frame of a function; `None` if the frame has none of the known forms.
    pub fn of(code: &Code) -> Option<Self> {
        let registers: Vec<u8> = code.words(0).map_while(pushed_register).collect();
        let is_ascending = registers.windows(2).all(|pair| pair[0] < pair[1]);
        let lowest = *registers.first()?;
        if !is_ascending
            || !registers
                .iter()
                .all(|register| CALL_SAVED.contains(register))
        {
            return None;
        }
        let (room, room_length) = match prologue_room(code, registers.len()) {
            Some((room, room_length)) => (room, room_length),
            None => (0, 0),
        };
        let has_room = room_length > 0;
        if has_room && !registers.ends_with(&[28, 29]) {
            return None;
        }
        let lowest = lowest.min(18);
        let first = FIRST_REGISTERS.iter().rposition(|first| *first <= lowest)?;
        let is_known = |register: &u8| *register >= FIRST_REGISTERS[first];
        let is_same = registers
            .iter()
            .eq(CALL_SAVED.iter().filter(|register| is_known(register)));
        let body = registers.len() + room_length;
        let mut epilogue_spans = Vec::new();
        let mut index = body;
        // Every use of the stack pointer and every pop has to belong to an epilogue.
        while let Some(instruction) = code.instructions.get(index) {
            if let Some(length) = epilogue_length(code, index, &registers, room, has_room) {
                let start = code.offset(index);
                epilogue_spans.push((start, code.offset(index + length) - start));
                index += length;
            } else if accesses_stack_pointer(instruction.code)
                || popped_register(instruction.code).is_some()
                || pushed_register(instruction.code).is_some()
                || instruction.code == RET
                || instruction.code == RETI
                || has_room && !is_same && !is_local(code, index, room)
            {
                return None;
            } else {
                index += 1;
            }
        }
        Some(Self {
            first,
            room,
            prologue_size: code.offset(body),
            epilogues: epilogue_spans,
        })
    }

    /// Returns the edits that make the function use the shared routines.
    pub fn edits(&self, routines: Routines) -> Vec<Edit> {
        let replace = |offset, remove, opcode, symbol| Edit {
            offset,
            remove,
            insert: vec![encode_ldi_r26(self.room), opcode, 0],
            references: vec![Reference {
                offset: 2,
                kind: elf::R_AVR_CALL,
                symbol,
                addend: 0,
            }],
        };
        let mut edits = vec![replace(0, self.prologue_size, CALL, routines.save)];
        edits.extend(
            self.epilogues
                .iter()
                .map(|(offset, size)| replace(*offset, *size, JMP, routines.restore)),
        );
        edits
    }
}

/// Returns the room in bytes that a prologue makes below the registers, and the number of instructions that make
/// it; `None` if no such instructions are at `index`.
fn prologue_room(code: &Code, index: usize) -> Option<(u8, usize)> {
    let words: Vec<u16> = code.words(index).take(9).collect();
    let (subtract_word, rest) = words.strip_prefix(&READ_STACK_POINTER)?.split_first()?;
    let (room, rest, count) = match (subtract_word, rest.split_first()) {
        // sbiw r28
        (subtract_word, _) if subtract_word & 0xff30 == 0x9720 => {
            (subtract_word >> 2 & 0x30 | subtract_word & 0x0f, rest, 8)
        }
        // subi r28 and sbci r29 with 0
        (subtract_word, Some((0x40d0, rest))) if subtract_word & 0xf0f0 == 0x50c0 => {
            (subtract_word >> 4 & 0xf0 | subtract_word & 0x0f, rest, 9)
        }
        _ => return None,
    };
    rest.starts_with(&WRITE_STACK_POINTER)
        .then_some((room as u8, count))
}

/// True if the instruction at an index uses the frame pointer only for the variables, from Y+1 to
/// Y+room, or does not use it.
fn is_local(code: &Code, index: usize, room: u8) -> bool {
    let words: Vec<u16> = code.words(index).take(3).collect();
    let distance = match *words.as_slice() {
        [word, ..] if !may_use_frame_pointer(word) => return true,
        // ldd and std with Y+q, of other registers than r28 and r29
        [word, ..] if word & 0xd008 == 0x8008 && word & 0x01e0 != 0x01c0 => {
            word >> 8 & 0x20 | word >> 7 & 0x18 | word & 7
        }
        // movw r30, r28 or another pair, then adiw of the same
        [copy, add, ..]
            if copy & 0xffcf == 0x01ce
                && copy & 0x0070 != 0x0060
                && add & 0xff30 == 0x9600 | copy & 0x0030 =>
        {
            add >> 2 & 0x30 | add & 0x0f
        }
        // movw r16, r28 or another pair, then subi and sbci of the same
        [copy, low, high]
            if copy & 0xff8f == 0x018e
                && copy & 0x0070 != 0x0060
                && low & 0xf0f0 == 0x5000 | copy << 1 & 0x00e0
                && high & 0xf0f0 == 0x4010 | copy << 1 & 0x00e0 =>
        {
            let byte = |word: u16| word >> 4 & 0xf0 | word & 0x0f;
            (byte(high) << 8 | byte(low)).wrapping_neg()
        }
        _ => return false,
    };
    (1..=u16::from(room)).contains(&distance)
}

/// Returns the number of instructions of the epilogue at an index; `None` if no epilogue that matches the
/// prologue begins there.
fn epilogue_length(
    code: &Code,
    index: usize,
    registers: &[u8],
    room: u8,
    has_room: bool,
) -> Option<usize> {
    let mut words = code.words(index).peekable();
    let mut count = 0;
    if has_room {
        let low = u16::from(room);
        let negative_room = low.wrapping_neg();
        let add_word = words.next()?;
        count += 1;
        if add_word != 0x9620 | low << 2 & 0xc0 | low & 0x0f || room > 63 {
            // subi r28 and sbci r29
            let expected_high = 0x40d0 | 0x0f0f;
            if add_word != 0x50c0 | negative_room << 4 & 0x0f00 | negative_room & 0x0f
                || words.next()? != expected_high
            {
                return None;
            }
            count += 1;
        }
        for word in WRITE_STACK_POINTER {
            if words.next()? != word {
                return None;
            }
        }
        count += WRITE_STACK_POINTER.len();
    }
    for register in registers.iter().rev() {
        if popped_register(words.next()?) != Some(*register) {
            return None;
        }
    }
    (words.next()? == RET).then_some(count + registers.len() + 1)
}
