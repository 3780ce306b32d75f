//! The greatest depth of the stack, computed from the machine code.
//!
//! On a chip without memory protection, a stack that grows into the static data can silently change a pulse width or a
//! decision of the guard. A measurement shows a depth that occurred, not the greatest possible depth: perhaps no
//! interrupt occurred at the worst moment, or a rare error message was not printed. This module therefore follows every
//! path through the code and adds up the pushed bytes.
//!
//! The module decodes the instructions itself instead of reading avr-objdump's listing: only some thirty instructions
//! matter to the stack, so the decoder is shorter than a parser of the listing, and the program needs no other tool.
//!
//! The bound rests on the following assumptions, and any violation is an error that names the function. Interrupts do
//! not nest, except that one other handler may interrupt a handler that never returns, such as the watchdog's. No
//! function calls itself, and no code jumps to a computed address. The stack pointer changes only by `push`, `pop`,
//! calls, returns, and stack frames addressed by r29:r28.

mod analysis;
mod instruction;

use simulated_uno::{Image, SRAM_END};

use analysis::{Context, StackAnalysis};

/// Number of vectors of an ATmega328P, including reset. Each is a `jmp` of four bytes.
const VECTOR_COUNT: u32 = 26;
/// Bytes that the entry into an interrupt pushes: the return address.
const INTERRUPT_ENTRY_BYTES: u16 = 2;

/// An error in the computation of a stack depth.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot compute the stack depth: {function}, at {address:#06x}, {reason}")]
pub struct StackError {
    /// The function with the error.
    pub function: String,
    /// Byte address in flash of the instruction with the error.
    pub address: u32,
    /// The reason, a phrase whose subject is the function, such as `calls itself`.
    pub reason: &'static str,
}

/// The greatest stack depths, bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StackDepth {
    /// The depth of the main program from reset, without interrupts.
    pub main: u16,
    /// The depth of the deepest interrupt handler, including its return address; 0 if there is no handler.
    pub handler: u16,
    /// The depth of the deepest handler that enables other interrupts and never returns, including its return address;
    /// 0 if there is none.
    pub nonreturning_handler: u16,
    /// Lowest SRAM address available to the stack.
    floor: u16,
}

impl StackDepth {
    /// Computes an image's depths. A `jmp` at address 0 marks a vector table; vectors that jump to avr-libc's
    /// `__bad_interrupt` are unused.
    ///
    /// # Errors
    /// See [`StackError`].
    pub fn compute(image: &Image) -> Result<Self, StackError> {
        let flash = image.flash();
        let bad_interrupt = image.symbol("__bad_interrupt");
        let bad_interrupt_address = bad_interrupt.map(|symbol| symbol.address as u32);
        let (mut handler, mut nonreturning_handler) = (0, 0);
        let mut analysis = StackAnalysis::new(image, &flash, Context::Interrupt);
        for vector in 1..VECTOR_COUNT {
            let target = instruction::find_jump_target(&flash, 0)
                .and_then(|_| instruction::find_jump_target(&flash, vector * 4));
            if let Some(target) = target.filter(|target| Some(*target) != bad_interrupt_address) {
                let summary = analysis.analyse_function(target)?;
                let depth = INTERRUPT_ENTRY_BYTES + summary.depth;
                match summary.interrupt_enable_address {
                    None => handler = handler.max(depth),
                    Some(address) if summary.can_return => {
                        let reason = "enables interrupts in an interrupt";
                        return Err(analysis.new_error(target, address, reason));
                    }
                    Some(_) => nonreturning_handler = nonreturning_handler.max(depth),
                }
            }
        }
        let mut analysis = StackAnalysis::new(image, &flash, Context::Main);
        Ok(Self {
            main: analysis.analyse_function(0)?.depth,
            handler,
            nonreturning_handler,
            floor: image.data_end(),
        })
    }

    /// Returns the greatest total depth: main at its deepest, plus the deepest handler that never returns, plus another
    /// interrupt.
    pub fn max_depth(&self) -> u16 {
        self.main + self.nonreturning_handler + self.handler
    }

    /// Returns the number of bytes between static data and the deepest stack; negative if they collide.
    pub fn margin(&self) -> i32 {
        i32::from(SRAM_END) - i32::from(self.floor) - i32::from(self.max_depth())
    }
}
