//! Prologues and epilogues of functions, and the calls of shared routines that replace them.
//!
//! A prologue pushes registers, from the lowest register to r29, and may reserve space for variables below them:
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
//! An epilogue frees the space, pops the registers in reverse order, and returns (`ret`).
//!
//! The routines also change r26, r0 and the flags. In the calling convention of avr-gcc and LLVM, a caller neither
//! relies on these after a call nor passes arguments in them: arguments are in r8 to r25 and on the stack, results in
//! r18 to r25. With LLVM's `-enable-ipra` a caller may rely on any register that the callee does not change, so never
//! combine this option with this program. A test checks the options in .cargo/config.toml.
//!
//! There are routines only for a few lists of registers. If a function pushes exactly one of these lists, the stack
//! layout in its body is unchanged. Otherwise the routine pushes more registers, so arguments on the stack are further
//! above the variables than the body assumes. Such a routine is used only if the body does not depend on this distance.
//! This is the case in two kinds of bodies.
//!
//! - The body uses no address on the stack: it has no variables on the stack and does not use the stack pointer.
//! - The body uses only addresses of variables, whose distances from r28 are unchanged. The body accesses Y+q within
//!   the space for the variables, or copies r28 and immediately adds a distance within this space; the body has no
//!   other use of r28 and r29. LLVM computes every address on the stack from r28, so each access to an argument has a
//!   distance beyond the space.

use std::ops::Range;

use object::build::elf::{Relocation, SymbolId};
use object::elf;

use crate::code::Code;
use crate::edit::Edit;
use crate::instruction::{
    CALL, JMP, READ_STACK_POINTER, RET, RETI, WRITE_STACK_POINTER, accesses_stack_pointer,
    encode_ldi_r26, may_use_frame_pointer, popped_register, pushed_register,
};

/// The call-saved registers, in the order in which they are pushed.
const CALL_SAVED: [u8; 18] = [
    2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 28, 29,
];

/// The lowest register that each pair of routines saves and restores, with all call-saved registers above it.
pub const LOWEST_REGISTERS: [u8; 9] = [2, 4, 6, 8, 10, 12, 14, 16, 18];

/// The pair of routines for one of [`LOWEST_REGISTERS`].
#[derive(Debug, Clone, Copy)]
pub struct Routines {
    /// The routine `__frame_save_K`.
    pub save: SymbolId,
    /// The routine `__frame_restore_K`.
    pub restore: SymbolId,
}

/// The stack frame of a function that has one of the known forms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// The index in [`LOWEST_REGISTERS`] of the routines that save all registers of the function.
    pub routine_index: usize,
    /// The size of the local variables on the stack, bytes.
    pub local_bytes: u8,
    /// The size of the prologue, bytes.
    pub prologue_size: u64,
    /// The offsets of each epilogue's bytes.
    pub epilogues: Vec<Range<u64>>,
}

impl Frame {
    /// Recognises the frame of a function. Returns `None` if the frame has none of the known forms.
    pub fn recognise(code: &Code) -> Option<Self> {
        let registers: Vec<u8> = code.words_from(0).map_while(pushed_register).collect();
        let is_ascending = registers.windows(2).all(|pair| pair[0] < pair[1]);
        let lowest = (*registers.first()?).min(18);
        let is_call_saved = |register: &u8| CALL_SAVED.contains(register);
        if !is_ascending || !registers.iter().all(is_call_saved) {
            return None;
        }
        let (local_bytes, reserving_count) = parse_reservation(code, registers.len()).unzip();
        if local_bytes.is_some() && !registers.ends_with(&[28, 29]) {
            return None;
        }
        let mut lowest_registers = LOWEST_REGISTERS.iter();
        let routine_index = lowest_registers.rposition(|register| *register <= lowest)?;
        let is_saved_by_routine = |register: &&u8| **register >= LOWEST_REGISTERS[routine_index];
        let saved_registers = CALL_SAVED.iter().filter(is_saved_by_routine);
        let has_same_registers = registers.iter().eq(saved_registers);
        let body_start = registers.len() + reserving_count.unwrap_or(0);
        let mut epilogues = Vec::new();
        let mut index = body_start;
        // Every use of the stack pointer, every push, pop and return must belong to an epilogue.
        while let Some(instruction) = code.instructions.get(index) {
            if let Some(length) = find_epilogue_length(code, index, &registers, local_bytes) {
                let end = code.instruction_offset(index + length);
                epilogues.push(code.instruction_offset(index)..end);
                index += length;
            } else if accesses_stack_pointer(instruction.first_word)
                || popped_register(instruction.first_word).is_some()
                || pushed_register(instruction.first_word).is_some()
                || instruction.first_word == RET
                || instruction.first_word == RETI
                || !has_same_registers
                    && local_bytes.is_some_and(|bytes| !uses_only_locals(code, index, bytes))
            {
                return None;
            } else {
                index += 1;
            }
        }
        Some(Self {
            routine_index,
            local_bytes: local_bytes.unwrap_or(0),
            prologue_size: code.instruction_offset(body_start),
            epilogues,
        })
    }

    /// Builds the edits that make the function use the shared routines.
    pub fn build_edits(&self, routines: Routines) -> Vec<Edit> {
        let replacement = |offset, removed_size, opcode, symbol| Edit {
            offset,
            removed_size,
            new_words: vec![encode_ldi_r26(self.local_bytes), opcode, 0],
            references: vec![Relocation {
                r_offset: 2,
                symbol: Some(symbol),
                r_type: elf::R_AVR_CALL,
                r_addend: 0,
            }],
        };
        let mut edits = vec![replacement(0, self.prologue_size, CALL, routines.save)];
        for epilogue in &self.epilogues {
            let size = epilogue.end - epilogue.start;
            edits.push(replacement(epilogue.start, size, JMP, routines.restore));
        }
        edits
    }
}

/// Parses the instructions at `index` with which a prologue reserves space below the registers. Returns the size of the
/// space in bytes and the number of instructions; `None` if there are no such instructions.
fn parse_reservation(code: &Code, index: usize) -> Option<(u8, usize)> {
    let words: Vec<u16> = code.words_from(index).take(9).collect();
    let (subtract_word, rest) = words.strip_prefix(&READ_STACK_POINTER)?.split_first()?;
    let (local_bytes, rest, count) = match (subtract_word, rest.split_first()) {
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
        .then_some((local_bytes as u8, count))
}

/// True if the instruction at an index uses the frame pointer only for the variables, between Y + 1 and
/// Y + `local_bytes`, or not at all.
fn uses_only_locals(code: &Code, index: usize, local_bytes: u8) -> bool {
    let words: Vec<u16> = code.words_from(index).take(3).collect();
    let distance = match *words.as_slice() {
        [word, ..] if !may_use_frame_pointer(word) => return true,
        // ldd and std with Y+q, of registers other than r28 and r29
        [word, ..] if word & 0xd008 == 0x8008 && word & 0x01e0 != 0x01c0 => {
            word >> 8 & 0x20 | word >> 7 & 0x18 | word & 7
        }
        // movw r30, r28 or another pair, then adiw of the same pair
        [copy, add, ..]
            if copy & 0xffcf == 0x01ce
                && copy & 0x0070 != 0x0060
                && add & 0xff30 == 0x9600 | copy & 0x0030 =>
        {
            add >> 2 & 0x30 | add & 0x0f
        }
        // movw r16, r28 or another pair, then subi and sbci of the same pair
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
    (1..=u16::from(local_bytes)).contains(&distance)
}

/// Returns the number of instructions of the epilogue at an index; `None` if no epilogue that matches the prologue
/// begins at the index. `local_bytes` is the size of the space that the prologue reserves, if it reserves any.
fn find_epilogue_length(
    code: &Code,
    index: usize,
    registers: &[u8],
    local_bytes: Option<u8>,
) -> Option<usize> {
    let mut words = code.words_from(index);
    let mut count = 0;
    if let Some(local_bytes) = local_bytes {
        let local_word = u16::from(local_bytes);
        let negated_word = local_word.wrapping_neg();
        let add_word = words.next()?;
        count += 1;
        if add_word != 0x9620 | local_word << 2 & 0xc0 | local_word & 0x0f || local_bytes > 63 {
            // subi r28 and sbci r29, instead of adiw r28
            let expected_high = 0x40d0 | 0x0f0f;
            if add_word != 0x50c0 | negated_word << 4 & 0x0f00 | negated_word & 0x0f
                || words.next()? != expected_high
            {
                return None;
            }
            count += 1;
        }
        let restoring_words = words.by_ref().take(WRITE_STACK_POINTER.len());
        if !restoring_words.eq(WRITE_STACK_POINTER) {
            return None;
        }
        count += WRITE_STACK_POINTER.len();
    }
    let popped_registers = words.by_ref().take(registers.len()).map(popped_register);
    let are_popped = popped_registers.eq(registers.iter().rev().copied().map(Some));
    (are_popped && words.next()? == RET).then_some(count + registers.len() + 1)
}
