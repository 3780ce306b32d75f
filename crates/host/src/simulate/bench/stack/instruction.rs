//! The effects of AVR instructions on the stack and on the flow of the program, by the AVR Instruction Set Manual.

/// The effect of an instruction. Addresses count bytes of flash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// No effect on stack or flow.
    None,
    Push,
    Pop,
    Call(u32),
    Jump(u32),
    /// Continues at this address or at the next instruction.
    Branch(u32),
    /// Executes or skips the next instruction.
    Skip,
    Return,
    /// An indirect jump or call: `ijmp`, `icall` and their extended forms.
    Indirect,
    /// Enables interrupts: `sei`.
    EnableInterrupts,
    /// r29:r28 gets the stack pointer (this is its low byte; the high one follows).
    PointerFromStack,
    /// The stack pointer gets r29:r28 (this is its low byte, which is written last).
    StackFromPointer,
    /// The stack pointer gets another value.
    StackFromOther,
    /// Adds a constant to r29:r28.
    AddToPointer(i16),
    /// The low half of a 16-bit subtraction from r29:r28: `subi r28`.
    SubtractLow(u8),
    /// The high half of a 16-bit subtraction from r29:r28: `sbci r29` or `sbc r29`.
    SubtractHigh(u8),
    /// r28 gets a constant: `ldi r28`.
    LoadLow(u8),
    /// r29 gets a constant: `ldi r29`.
    LoadHigh(u8),
    /// r29:r28 gets another value.
    LosePointer,
    /// `ldi r26`: the frame size that a shared prologue or epilogue gets.
    LoadFrameSize(u8),
}

/// A decoded instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    pub effect: Effect,
    /// Length of the instruction, bytes: 2 or 4.
    pub size: u32,
}

/// I/O address of the stack pointer's low byte.
const SPL: u16 = 0x3d;
/// I/O address of the stack pointer's high byte.
const SPH: u16 = 0x3e;
/// Data addresses of the stack pointer's low and high bytes.
const SP_DATA: [u16; 2] = [0x5d, 0x5e];

/// Decodes the instruction at a byte address; `None` if flash ends before the instruction does.
pub fn decode(flash: &[u8], address: u32) -> Option<Instruction> {
    let code = word(flash, address)?;
    let is_long = code & 0xfe0f == 0x9000 // lds
        || code & 0xfe0f == 0x9200 // sts
        || code & 0xfe0c == 0x940c; // jmp, call
    let size = if is_long { 4 } else { 2 };
    let second_word = if is_long {
        word(flash, address + 2)?
    } else {
        0
    };
    let effect = decode_effect(code, second_word, address);
    Some(Instruction { effect, size })
}

/// The target of the `jmp` or `rjmp` at a byte address; `None` for any other instruction.
pub fn jump_target(flash: &[u8], address: u32) -> Option<u32> {
    match decode(flash, address)?.effect {
        Effect::Jump(target) => Some(target),
        _ => None,
    }
}

/// Reads the word at a byte address; `None` if flash ends before the word does.
fn word(flash: &[u8], address: u32) -> Option<u16> {
    let address = address as usize;
    let bytes = flash.get(address..address + 2)?;
    Some(u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// The effect of the instruction with these words at a byte address; `second_word` is 0 if there is only one word.
fn decode_effect(code: u16, second_word: u16, address: u32) -> Effect {
    let register = code >> 4 & 0x1f;
    match code {
        0x9508 | 0x9518 => Effect::Return, // ret, reti
        0x9409 | 0x9419 | 0x9509 | 0x9519 => Effect::Indirect,
        0x9478 => Effect::EnableInterrupts,
        _ if code & 0xfe0f == 0x920f => Effect::Push,
        _ if code & 0xfe0f == 0x900f => Effect::Pop,
        _ if code & 0xfe0e == 0x940e => Effect::Call(far_target(code, second_word)),
        _ if code & 0xfe0e == 0x940c => Effect::Jump(far_target(code, second_word)),
        _ if code & 0xf000 == 0xc000 => Effect::Jump(relative_target(code, 12, address)), // rjmp
        _ if code & 0xf000 == 0xd000 => Effect::Call(relative_target(code, 12, address)), // rcall
        _ if code & 0xf800 == 0xf000 => Effect::Branch(relative_target(code >> 3, 7, address)),
        // cpse; sbrc and sbrs; sbic and sbis
        _ if code & 0xfc00 == 0x1000 => Effect::Skip,
        _ if code & 0xfc08 == 0xfc00 => Effect::Skip,
        _ if code & 0xfd00 == 0x9900 => Effect::Skip,
        _ if code & 0xfe0f == 0x9200 && SP_DATA.contains(&second_word) => Effect::StackFromOther,
        _ if code & 0xf800 == 0xb000 => match (io_address(code), register) {
            (SPL, 28) => Effect::PointerFromStack,
            (SPH, 29) => Effect::None,
            (_, 28 | 29) => Effect::LosePointer,
            _ => Effect::None,
        },
        _ if code & 0xf800 == 0xb800 => match (io_address(code), register) {
            (SPL, 28) => Effect::StackFromPointer,
            (SPH, 29) => Effect::None,
            (SPL | SPH, _) => Effect::StackFromOther,
            _ => Effect::None,
        },
        // adiw and sbiw of r29:r28
        _ if code & 0xff30 == 0x9620 => Effect::AddToPointer(small_constant(code)),
        _ if code & 0xff30 == 0x9720 => Effect::AddToPointer(-small_constant(code)),
        // subi, sbci and ldi have r16 to r31 only
        _ if code & 0xf0f0 == 0x50c0 => Effect::SubtractLow(byte_constant(code)),
        _ if code & 0xf0f0 == 0x40d0 => Effect::SubtractHigh(byte_constant(code)),
        0x09d1 => Effect::SubtractHigh(0), // sbc r29, r1, which is always 0
        _ if code & 0xf0f0 == 0xe0a0 => Effect::LoadFrameSize(byte_constant(code)),
        _ if code & 0xf0f0 == 0xe0c0 => Effect::LoadLow(byte_constant(code)),
        _ if code & 0xf0f0 == 0xe0d0 => Effect::LoadHigh(byte_constant(code)),
        _ if code & 0xfff0 == 0x01e0 => Effect::LosePointer, // movw r28
        _ => Effect::None,
    }
}

/// The target of `jmp` and `call`: 22 bits, which count words.
fn far_target(code: u16, second_word: u16) -> u32 {
    let high = u32::from(code >> 3 & 0x3e | code & 1);
    (high << 16 | u32::from(second_word)) * 2
}

/// A target relative to the next instruction: a signed number of words with this many bits.
fn relative_target(offset: u16, bits: u32, address: u32) -> u32 {
    let shift = 16 - bits;
    let word_offset = (offset << shift) as i16 >> shift;
    address
        .wrapping_add(2)
        .wrapping_add_signed(i32::from(word_offset) * 2)
}

/// The I/O address of `in` and `out`.
fn io_address(code: u16) -> u16 {
    code >> 5 & 0x30 | code & 0x0f
}

/// The constant of `adiw` and `sbiw`.
fn small_constant(code: u16) -> i16 {
    (code >> 2 & 0x30 | code & 0x0f) as i16
}

/// The constant of `ldi` and similar instructions.
fn byte_constant(code: u16) -> u8 {
    (code >> 4 & 0xf0 | code & 0x0f) as u8
}
