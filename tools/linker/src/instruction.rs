//! Properties of AVR instructions that determine how code may be edited, from the AVR Instruction Set Manual. A
//! parameter `word` is the first word of an instruction.

/// The opcode of `ret`.
pub const RET: u16 = 0x9508;
/// The opcode of `reti`.
pub const RETI: u16 = 0x9518;
/// The first word of `call`, whose target is in the next word.
pub const CALL: u16 = 0x940e;
/// The first word of `jmp`, whose target is in the next word.
pub const JMP: u16 = 0x940c;
/// The instructions that copy the stack pointer to the frame pointer: `in r28, SPL`, `in r29, SPH`.
pub const READ_STACK_POINTER: [u16; 2] = [0xb7cd, 0xb7de];
/// The instructions that copy the frame pointer to the stack pointer, in a prologue and in an epilogue: `in r0, SREG`,
/// `cli`, `out SPH, r29`, `out SREG, r0`, `out SPL, r28`.
pub const WRITE_STACK_POINTER: [u16; 5] = [0xb60f, 0x94f8, 0xbfde, 0xbe0f, 0xbfcd];

/// True for an instruction of two words: `lds`, `sts`, `jmp`, `call`.
pub const fn is_two_words(word: u16) -> bool {
    word & 0xfe0f == 0x9000 || word & 0xfe0f == 0x9200 || word & 0xfe0c == 0x940c
}

/// Returns the register that a `push` pushes; `None` for any other instruction.
pub fn pushed_register(word: u16) -> Option<u8> {
    (word & 0xfe0f == 0x920f).then_some((word >> 4 & 0x1f) as u8)
}

/// Returns the register that a `pop` pops; `None` for any other instruction.
pub fn popped_register(word: u16) -> Option<u8> {
    (word & 0xfe0f == 0x900f).then_some((word >> 4 & 0x1f) as u8)
}

/// Returns the instruction `ldi r26, value`.
pub const fn encode_ldi_r26(value: u8) -> u16 {
    let value = value as u16;
    0xe0a0 | value << 4 & 0x0f00 | value & 0x0f
}

/// True for an instruction with a relative target: a branch, `rjmp` or `rcall`.
pub const fn is_relative(word: u16) -> bool {
    is_branch(word) || word & 0xe000 == 0xc000
}

/// True for a branch on a flag.
pub const fn is_branch(word: u16) -> bool {
    word & 0xf800 == 0xf000
}

/// True for `rjmp`.
pub const fn is_rjmp(word: u16) -> bool {
    word & 0xf000 == 0xc000
}

/// True for `call` and `rcall`.
pub const fn is_call(word: u16) -> bool {
    word & 0xfe0e == CALL || word & 0xf000 == 0xd000
}

/// True for an instruction that may skip the next instruction: `cpse`, `sbrc`, `sbrs`, `sbic`, `sbis`.
pub const fn may_skip_next(word: u16) -> bool {
    word & 0xfc00 == 0x1000 || word & 0xfc08 == 0xfc00 || word & 0xfd00 == 0x9900
}

/// True if an instruction reads or writes the stack pointer with `in` or `out`.
pub const fn accesses_stack_pointer(word: u16) -> bool {
    let port = word >> 5 & 0x30 | word & 0x0f;
    word & 0xf000 == 0xb000 && (port == 0x3d || port == 0x3e)
}

/// True if an instruction has r28 or r29 as an operand, or uses Y. Also true for `lpm` without an operand, which uses
/// neither.
pub fn may_use_frame_pointer(word: u16) -> bool {
    let is_frame_pointer = |register: u16| register == 28 || register == 29;
    let first_operand = word >> 4 & 0x1f;
    let second_operand = word >> 5 & 0x10 | word & 0x0f;
    let upper_operand = 16 + (word >> 4 & 0x0f);
    match word {
        // nop and movw of register pairs
        0x0000..=0x01ff => upper_operand == 16 + 14 || word & 0x0f == 14,
        // muls, mulsu and fmul* of r16 to r31
        0x0200..=0x03ff => is_frame_pointer(upper_operand) || is_frame_pointer(16 + (word & 0x0f)),
        // Two register operands; mul
        0x0400..=0x2fff | 0x9c00..=0x9fff => {
            is_frame_pointer(first_operand) || is_frame_pointer(second_operand)
        }
        // Immediate operand
        0x3000..=0x7fff | 0xe000..=0xefff => is_frame_pointer(upper_operand),
        // ldd and std
        0x8000..=0x8fff | 0xa000..=0xafff => is_frame_pointer(first_operand) || word & 8 != 0,
        // Other loads and stores
        0x9000..=0x93ff => is_frame_pointer(first_operand) || word & 0x0f == 9 || word & 0x0f == 10,
        // One register operand
        0x9400..=0x95ff => is_frame_pointer(first_operand),
        // adiw and sbiw
        0x9600..=0x97ff => word & 0x30 == 0x20,
        // cbi, sbi, sbic, sbis; rjmp, rcall and branches
        0x9800..=0x9bff | 0xc000..=0xdfff | 0xf000..=0xf7ff => false,
        // in and out; bld, bst, sbrc, sbrs
        0xb000..=0xbfff | 0xf800..=0xffff => is_frame_pointer(first_operand),
    }
}

/// True if execution may continue after `word`, the last instruction of a function. False for a call, because a
/// compiler ends a function only with a call that never returns.
pub const fn falls_through(word: u16) -> bool {
    let is_return = word == RET || word == RETI;
    let is_jump = is_rjmp(word) || word & 0xfe0e == JMP || word & 0xffef == 0x9409;
    !(is_return || is_jump || is_call(word))
}
