//! The effects of AVR instructions on the stack and the control flow, according to the AVR Instruction Set Manual.

/// The effect of an instruction. Addresses are byte addresses in flash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// No effect on the stack or the control flow.
    None,
    /// Pushes a byte.
    Push,
    /// Pops a byte.
    Pop,
    /// Calls the function at this address.
    Call(u32),
    /// Continues at this address.
    Jump(u32),
    /// Continues at this address or at the next instruction.
    Branch(u32),
    /// Executes or skips the next instruction.
    Skip,
    /// Returns from a function or an interrupt.
    Return,
    /// Jumps to or calls a computed address: `ijmp`, `icall` and their extended forms.
    Indirect,
    /// Enables interrupts: `sei`.
    EnableInterrupts,
    /// Copies the stack pointer to r29:r28. This instruction copies the low byte; the high byte follows.
    PointerFromStack,
    /// Copies r29:r28 to the stack pointer. This instruction copies the low byte, which is written last.
    StackFromPointer,
    /// Sets the stack pointer to a value other than r29:r28.
    StackFromOther,
    /// Adds a constant to r29:r28.
    AddToPointer(i16),
    /// Subtracts the low byte of a 16-bit subtraction from r29:r28: `subi r28`.
    SubtractLow(u8),
    /// Subtracts the high byte of a 16-bit subtraction from r29:r28: `sbci r29` or `sbc r29`.
    SubtractHigh(u8),
    /// Loads a constant into r28: `ldi r28`.
    LoadLow(u8),
    /// Loads a constant into r29: `ldi r29`.
    LoadHigh(u8),
    /// Sets r29:r28 to an unknown value.
    LosePointer,
    /// Loads a constant, the frame size for a shared prologue or epilogue, into r26: `ldi r26`.
    LoadFrameSize(u8),
}

/// A decoded instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    /// Effect on the stack and the control flow.
    pub effect: Effect,
    /// Length of the instruction, bytes: 2 or 4.
    pub size: u32,
}

/// I/O address of the stack pointer's low byte.
const SPL: u16 = 0x3d;
/// I/O address of the stack pointer's high byte.
const SPH: u16 = 0x3e;
/// Data addresses of the stack pointer's low and high bytes, for `sts`.
const SP_DATA_ADDRESSES: [u16; 2] = [0x5d, 0x5e];

/// Decodes the instruction at a byte address; `None` if flash ends before the end of the instruction.
pub fn decode(flash: &[u8], address: u32) -> Option<Instruction> {
    let opcode = read_word(flash, address)?;
    let is_long = opcode & 0xfe0f == 0x9000 // lds
        || opcode & 0xfe0f == 0x9200 // sts
        || opcode & 0xfe0c == 0x940c; // jmp, call
    let (size, second_word) = if is_long {
        (4, read_word(flash, address + 2)?)
    } else {
        (2, 0)
    };
    let effect = decode_effect(opcode, second_word, address);
    Some(Instruction { effect, size })
}

/// Returns the target of the `jmp` or `rjmp` at a byte address; `None` for any other instruction.
pub fn find_jump_target(flash: &[u8], address: u32) -> Option<u32> {
    match decode(flash, address)?.effect {
        Effect::Jump(target) => Some(target),
        _ => None,
    }
}

/// Reads the word at a byte address; `None` if flash ends before the end of the word.
fn read_word(flash: &[u8], address: u32) -> Option<u16> {
    let address = address as usize;
    let bytes = flash.get(address..address + 2)?;
    Some(u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// Decodes the effect of the instruction at a byte address; `second_word` is 0 for an instruction of one word.
fn decode_effect(opcode: u16, second_word: u16, address: u32) -> Effect {
    let register = opcode >> 4 & 0x1f;
    match opcode {
        0x9508 | 0x9518 => Effect::Return, // ret, reti
        0x9409 | 0x9419 | 0x9509 | 0x9519 => Effect::Indirect,
        0x9478 => Effect::EnableInterrupts,
        _ if opcode & 0xfe0f == 0x920f => Effect::Push,
        _ if opcode & 0xfe0f == 0x900f => Effect::Pop,
        _ if opcode & 0xfe0e == 0x940e => Effect::Call(decode_far_target(opcode, second_word)),
        _ if opcode & 0xfe0e == 0x940c => Effect::Jump(decode_far_target(opcode, second_word)),
        _ if opcode & 0xf000 == 0xc000 => Effect::Jump(decode_relative_target(opcode, 12, address)), // rjmp
        _ if opcode & 0xf000 == 0xd000 => Effect::Call(decode_relative_target(opcode, 12, address)), // rcall
        _ if opcode & 0xf800 == 0xf000 => {
            Effect::Branch(decode_relative_target(opcode >> 3, 7, address))
        }
        // cpse; sbrc and sbrs; sbic and sbis
        _ if opcode & 0xfc00 == 0x1000 => Effect::Skip,
        _ if opcode & 0xfc08 == 0xfc00 => Effect::Skip,
        _ if opcode & 0xfd00 == 0x9900 => Effect::Skip,
        _ if opcode & 0xfe0f == 0x9200 && SP_DATA_ADDRESSES.contains(&second_word) => {
            Effect::StackFromOther
        }
        _ if opcode & 0xf800 == 0xb000 => match (decode_io_address(opcode), register) {
            (SPL, 28) => Effect::PointerFromStack,
            (SPH, 29) => Effect::None,
            (_, 28 | 29) => Effect::LosePointer,
            _ => Effect::None,
        },
        _ if opcode & 0xf800 == 0xb800 => match (decode_io_address(opcode), register) {
            (SPL, 28) => Effect::StackFromPointer,
            (SPH, 29) => Effect::None,
            (SPL | SPH, _) => Effect::StackFromOther,
            _ => Effect::None,
        },
        // adiw and sbiw with r29:r28
        _ if opcode & 0xff30 == 0x9620 => Effect::AddToPointer(decode_small_constant(opcode)),
        _ if opcode & 0xff30 == 0x9720 => Effect::AddToPointer(-decode_small_constant(opcode)),
        // subi, sbci and ldi work only with r16 to r31
        _ if opcode & 0xf0f0 == 0x50c0 => Effect::SubtractLow(decode_byte_constant(opcode)),
        _ if opcode & 0xf0f0 == 0x40d0 => Effect::SubtractHigh(decode_byte_constant(opcode)),
        0x09d1 => Effect::SubtractHigh(0), // sbc r29, r1, which is always 0
        _ if opcode & 0xf0f0 == 0xe0a0 => Effect::LoadFrameSize(decode_byte_constant(opcode)),
        _ if opcode & 0xf0f0 == 0xe0c0 => Effect::LoadLow(decode_byte_constant(opcode)),
        _ if opcode & 0xf0f0 == 0xe0d0 => Effect::LoadHigh(decode_byte_constant(opcode)),
        _ if opcode & 0xfff0 == 0x01e0 => Effect::LosePointer, // movw r28
        _ => Effect::None,
    }
}

/// Returns the target of `jmp` or `call` as a byte address; it is encoded as a word address of 22 bits.
fn decode_far_target(opcode: u16, second_word: u16) -> u32 {
    let high = u32::from(opcode >> 3 & 0x3e | opcode & 1);
    (high << 16 | u32::from(second_word)) * 2
}

/// Returns the byte address of a target relative to the next instruction. The lowest `offset_bits` bits of
/// `encoded_offset` are a signed number of words.
fn decode_relative_target(encoded_offset: u16, offset_bits: u32, address: u32) -> u32 {
    let shift = 16 - offset_bits;
    let word_offset = (encoded_offset << shift) as i16 >> shift;
    let next_address = address.wrapping_add(2);
    next_address.wrapping_add_signed(i32::from(word_offset) * 2)
}

/// Returns the I/O address of `in` and `out`.
fn decode_io_address(opcode: u16) -> u16 {
    opcode >> 5 & 0x30 | opcode & 0x0f
}

/// Returns the constant of `adiw` and `sbiw`.
fn decode_small_constant(opcode: u16) -> i16 {
    (opcode >> 2 & 0x30 | opcode & 0x0f) as i16
}

/// Returns the constant of `ldi` and similar instructions.
fn decode_byte_constant(opcode: u16) -> u8 {
    (opcode >> 4 & 0xf0 | opcode & 0x0f) as u8
}
