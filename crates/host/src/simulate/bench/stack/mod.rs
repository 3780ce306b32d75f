//! The greatest depth of the stack, computed from the machine code.
//!
//! On a chip without memory protection, a stack that grows into the static data changes a
//! servo's width or a decision of the guard, and nothing reports it. A measurement shows
//! how deep the stack got, and not how deep it can get: perhaps no interrupt came at the
//! worst moment, or a rare refusal was not printed. So this module follows every path
//! through the code and adds up what it pushes.
//!
//! It decodes the code itself and does not read avr-objdump's listing: only some thirty
//! instructions matter to the stack, which takes fewer lines than a parser of that
//! listing, and the program needs no other tool.
//!
//! The bound assumes the following. Interrupts do not nest, which is checked; only a handler that never returns,
//! such as the watchdog's, may be interrupted once more. No function calls itself, nothing jumps to a computed
//! address, and the stack pointer changes only by `push`, `pop`, calls, returns, and frames that r28 and r29 point
//! to. Anything else is refused, with the name of the function.

mod instruction;
mod walk;

use simulated_uno::{Image, SRAM_END};

use walk::{Context, Walk};

/// Vectors of an ATmega328P, reset included, each a `jmp` of four bytes.
const VECTOR_COUNT: u32 = 26;
/// Bytes that an interrupt pushes: its return address.
const ENTRY_BYTES: u16 = 2;

/// The reason why a depth cannot be computed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the depth of the stack cannot be computed: {function}, at {address:#06x}, {what}")]
pub struct StackError {
    /// The function that cannot be analysed.
    pub function: String,
    /// Byte address of its instruction in flash.
    pub address: u32,
    /// The reason why that instruction cannot be analysed, in words.
    pub what: &'static str,
}

/// The worst depths, bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StackDepth {
    /// The depth of the program from reset on, without interrupts.
    pub main: u16,
    /// The depth of the deepest interrupt, with its return address; 0 without interrupts.
    pub handler: u16,
    /// The depth of the deepest interrupt that enables others and never returns; 0 without one.
    pub final_handler: u16,
    /// First address of SRAM that the stack may use.
    floor: u16,
}

impl StackDepth {
    /// Computes an image's depths. A vector table is recognised by the `jmp` at
    /// address 0; vectors that jump to avr-libc's `__bad_interrupt` are not in use.
    ///
    /// # Errors
    /// See [`StackError`].
    pub fn of(image: &Image) -> Result<Self, StackError> {
        let flash = image.flash();
        let unused_target = image.symbol("__bad_interrupt");
        let unused_target = unused_target.map(|symbol| symbol.address as u32);
        let (mut handler_depth, mut final_depth) = (0, 0);
        let mut walk = Walk::new(image, &flash, Context::Interrupt);
        for vector in 1..VECTOR_COUNT {
            let target = instruction::jump_target(&flash, 0)
                .and_then(|_| instruction::jump_target(&flash, vector * 4));
            if let Some(target) = target.filter(|target| Some(*target) != unused_target) {
                let function = walk.analyse_function(target)?;
                match function.interrupts_enabled_at {
                    None => handler_depth = handler_depth.max(ENTRY_BYTES + function.depth),
                    Some(address) if function.can_return => {
                        let reason = "lets interrupts into an interrupt";
                        return Err(walk.error_at(target, address, reason));
                    }
                    Some(_) => final_depth = final_depth.max(ENTRY_BYTES + function.depth),
                }
            }
        }
        let main_depth = Walk::new(image, &flash, Context::Main)
            .analyse_function(0)?
            .depth;
        let floor = image.data_end();
        Ok(Self {
            main: main_depth,
            handler: handler_depth,
            final_handler: final_depth,
            floor,
        })
    }

    /// The deepest stack of all: main at its deepest, on top of it the interrupt that never returns, if there is
    /// one, and another interrupt.
    pub fn worst(&self) -> u16 {
        self.main + self.final_handler + self.handler
    }

    /// Bytes between static data and the deepest stack; negative if they collide.
    pub fn margin(&self) -> i32 {
        i32::from(SRAM_END) - i32::from(self.floor) - i32::from(self.worst())
    }
}
