//! Follows every path through a function and counts the bytes on the stack at each instruction.

use std::collections::HashMap;

use simulated_uno::{Image, SRAM_END};

use super::StackError;
use super::instruction::{Effect, decode};

/// Bytes that a call pushes.
const RETURN_ADDRESS_BYTES: i32 = 2;

/// The context in which the analysed code runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Context {
    /// The main program, from reset.
    Main,
    /// An interrupt handler, with interrupts off.
    Interrupt,
}

/// The contents of r29:r28.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pointer {
    /// An unknown value.
    Unknown,
    /// The stack pointer after this number of bytes were pushed since the function's entry.
    Depth(i32),
    /// A constant address.
    Address(u16),
}

/// The abstract state before an instruction, valid for every path to the instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    /// Bytes pushed since the function's entry.
    depth: i32,
    /// The contents of r29:r28.
    pointer: Pointer,
    /// The low byte of a 16-bit subtraction from r29:r28, until the instruction for the high byte.
    low_byte: u8,
    /// The constant that the previous instruction loaded into r26; `None` if it did not load r26.
    frame_size: Option<u8>,
}

/// The stack analysis of an image, with the functions analysed so far.
pub struct StackAnalysis<'a> {
    image: &'a Image,
    flash: &'a [u8],
    context: Context,
    /// The number of bytes that each shared prologue (`tools/linker/src/frames.S`) saves, by the prologue's address.
    saved_bytes: HashMap<u32, i32>,
    /// The number of bytes that each shared epilogue restores, by the epilogue's address.
    restored_bytes: HashMap<u32, i32>,
    /// Each function's summary, by function address; `None` while the function is being analysed.
    summaries: HashMap<u32, Option<FunctionSummary>>,
}

/// A function's effect on the stack.
#[derive(Debug, Clone, Copy)]
pub struct FunctionSummary {
    /// Greatest stack use of the function and its callees, bytes, without the function's own return address.
    pub depth: u16,
    /// True if the function returns. Code after a call of a function that never returns is not part of the caller.
    pub can_return: bool,
    /// Byte address where an interrupt handler enables other interrupts; `None` if it never does.
    pub interrupt_enable_address: Option<u32>,
}

impl<'a> StackAnalysis<'a> {
    /// Creates an analysis of `flash`, the contents of `image`, without any analysed function.
    pub fn new(image: &'a Image, flash: &'a [u8], context: Context) -> Self {
        // Shared routine K saves or restores rK to r17, r28 and r29, a total of 20 - K bytes, and a frame with the size
        // in r26.
        let find_routines = |prefix: &str| {
            let parse_symbol = |symbol: &simulated_uno::Symbol| {
                let first_register: i32 = symbol.name.strip_prefix(prefix)?.parse().ok()?;
                Some((symbol.address as u32, 20 - first_register))
            };
            image.symbols().iter().filter_map(parse_symbol).collect()
        };
        Self {
            image,
            flash,
            context,
            saved_bytes: find_routines("__frame_save_"),
            restored_bytes: find_routines("__frame_restore_"),
            summaries: HashMap::new(),
        }
    }

    /// Analyses the function at byte address `entry` and all functions that it calls.
    pub fn analyse_function(&mut self, entry: u32) -> Result<FunctionSummary, StackError> {
        match self.summaries.get(&entry) {
            Some(Some(summary)) => return Ok(*summary),
            Some(None) => return Err(self.new_error(entry, entry, "calls itself")),
            None => {}
        }
        self.summaries.insert(entry, None);
        let summary = self.follow_paths(entry)?;
        self.summaries.insert(entry, Some(summary));
        Ok(summary)
    }

    /// Follows every path through the function at `entry`.
    fn follow_paths(&mut self, entry: u32) -> Result<FunctionSummary, StackError> {
        let mut max_depth = 0;
        let mut can_return = false;
        let mut interrupt_enable_address = None;
        let mut states: HashMap<u32, State> = HashMap::new();
        let start_state = State {
            depth: 0,
            pointer: Pointer::Unknown,
            low_byte: 0,
            frame_size: None,
        };
        let mut pending = vec![(entry, start_state)];
        while let Some((address, mut state)) = pending.pop() {
            let error = |reason| self.new_error(entry, address, reason);
            if let Some(known_state) = states.get(&address) {
                if known_state.depth != state.depth {
                    return Err(error("is reached with different stack depths"));
                }
                if known_state.pointer == state.pointer || known_state.pointer == Pointer::Unknown {
                    continue;
                }
                state.pointer = Pointer::Unknown;
            }
            states.insert(address, state);
            let Some(instruction) = decode(self.flash, address) else {
                return Err(error("runs beyond the end of the code"));
            };
            let next_address = address + instruction.size;
            let frame_bytes = state.frame_size.take().map(i32::from);
            let unknown_frame = || error("reserves a frame of an unknown size");
            let mut next_addresses = vec![next_address];
            match instruction.effect {
                // The compiler reserves two bytes by calling the next instruction, which is shorter than two pushes.
                Effect::Call(target) if target == next_address => {
                    state.depth += RETURN_ADDRESS_BYTES
                }
                Effect::Call(target) if self.saved_bytes.contains_key(&target) => {
                    let frame_bytes = frame_bytes.ok_or_else(unknown_frame)?;
                    state.depth += self.saved_bytes[&target] + frame_bytes;
                    state.pointer = Pointer::Depth(state.depth);
                    // The shared prologue's return address lies below the frame that the prologue reserves.
                    max_depth = max_depth.max(state.depth + RETURN_ADDRESS_BYTES);
                }
                Effect::Jump(target) if self.restored_bytes.contains_key(&target) => {
                    let frame_bytes = frame_bytes.ok_or_else(unknown_frame)?;
                    if state.depth != self.restored_bytes[&target] + frame_bytes {
                        return Err(error("restores different registers than it saved"));
                    }
                    can_return = true;
                    next_addresses.clear();
                }
                Effect::Call(target) => {
                    let callee = self.analyse_function(target)?;
                    let callee_depth = i32::from(callee.depth);
                    max_depth = max_depth.max(state.depth + RETURN_ADDRESS_BYTES + callee_depth);
                    interrupt_enable_address =
                        interrupt_enable_address.or(callee.interrupt_enable_address);
                    if !callee.can_return {
                        next_addresses.clear();
                    }
                }
                // The program restarts with an empty stack.
                Effect::Jump(0) => next_addresses.clear(),
                Effect::Jump(target) => next_addresses = vec![target],
                Effect::Branch(target) => next_addresses.push(target),
                Effect::Skip => {
                    let skipped_size =
                        decode(self.flash, next_address).map_or(2, |skipped| skipped.size);
                    next_addresses.push(next_address + skipped_size);
                }
                Effect::Return if state.depth == 0 => {
                    can_return = true;
                    next_addresses.clear();
                }
                Effect::Return => return Err(error("returns with bytes on the stack")),
                Effect::Indirect => return Err(error("jumps to a computed address")),
                Effect::EnableInterrupts if self.context == Context::Interrupt => {
                    interrupt_enable_address = Some(address);
                }
                effect => state
                    .apply(effect)
                    .ok_or_else(|| error("sets the stack pointer to an unknown value"))?,
            }
            max_depth = max_depth.max(state.depth);
            pending.extend(next_addresses.into_iter().map(|address| (address, state)));
        }
        let depth = u16::try_from(max_depth)
            .map_err(|_| self.new_error(entry, entry, "needs more stack than is available"))?;
        Ok(FunctionSummary {
            depth,
            can_return,
            interrupt_enable_address,
        })
    }

    /// Creates an error in the function at `entry`, caused by the instruction at `address`.
    pub fn new_error(&self, entry: u32, address: u32, reason: &'static str) -> StackError {
        let is_at_or_before = |symbol: &&simulated_uno::Symbol| {
            symbol.is_function && u64::from(entry) >= symbol.address
        };
        let symbols = self.image.symbols().iter().filter(is_at_or_before);
        let nearest_symbol = symbols.max_by_key(|symbol| symbol.address);
        StackError {
            function: nearest_symbol.map_or_else(|| "the code".to_owned(), |symbol| symbol.path()),
            address,
            reason,
        }
    }
}

impl State {
    /// Applies an instruction that only changes the stack, the stack pointer or r29:r28. Returns `None` if the stack
    /// pointer would become unknown.
    fn apply(&mut self, effect: Effect) -> Option<()> {
        let offset_pointer = |pointer: Pointer, change: i16| match pointer {
            Pointer::Depth(depth) => Pointer::Depth(depth - i32::from(change)),
            Pointer::Address(address) => Pointer::Address(address.wrapping_add_signed(change)),
            Pointer::Unknown => Pointer::Unknown,
        };
        match effect {
            Effect::Push => self.depth += 1,
            Effect::Pop => self.depth -= 1,
            Effect::PointerFromStack => self.pointer = Pointer::Depth(self.depth),
            Effect::StackFromPointer => {
                self.depth = match self.pointer {
                    Pointer::Depth(depth) => depth,
                    // The startup code sets a constant. The stack grows down from the end of SRAM.
                    Pointer::Address(address) => i32::from(SRAM_END - 1) - i32::from(address),
                    Pointer::Unknown => return None,
                }
            }
            Effect::StackFromOther => return None,
            Effect::AddToPointer(change) => self.pointer = offset_pointer(self.pointer, change),
            Effect::SubtractLow(low) => self.low_byte = low,
            Effect::SubtractHigh(high) => {
                let amount = i16::from_le_bytes([self.low_byte, high]);
                self.pointer = offset_pointer(self.pointer, amount.wrapping_neg());
            }
            Effect::LoadLow(low) => self.pointer = Pointer::Address(low.into()),
            Effect::LoadHigh(high) => {
                self.pointer = match self.pointer {
                    Pointer::Address(low) => Pointer::Address(low & 0xff | u16::from(high) << 8),
                    _ => Pointer::Unknown,
                }
            }
            Effect::LoadFrameSize(size) => self.frame_size = Some(size),
            Effect::LosePointer => self.pointer = Pointer::Unknown,
            _ => {}
        }
        Some(())
    }
}
