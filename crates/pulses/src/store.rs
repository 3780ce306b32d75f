//! A cycle-exact store to a port register.

use core::arch::asm;

/// Stores `base | set_mask` in `port` a fixed number of cycles after Timer1 reaches `count` (low byte first), and
/// returns 0xff. If this count has passed, stores `base` at once and returns 0.
///
/// For a falling edge the caller passes a `set_mask` of 0. The instructions are the same as for a rising edge, so their
/// time cancels out of the width.
///
/// # Safety
/// `port` must be the PORT register of a servo pin. Interrupts must be off, so that `base` stays valid for the other
/// pins until the store. `count` must be at most 255 cycles ahead.
#[inline(always)]
pub unsafe fn store_at(count: [u8; 2], port: *mut u8, base: u8, set_mask: u8) -> u8 {
    let [remaining, high] = count;
    let on_time_mask: u8;
    // SAFETY: reads TCNT1 (the low byte first, which latches the high byte), and writes to `port`, which by the
    // contract is a PORT register.
    unsafe {
        asm!(
            // remaining = count - now
            "lds {now}, {tcnt1l}",
            "sub {remaining}, {now}",
            "lds {now}, {tcnt1h}",
            "sbc {on_time_mask}, {now}",
            // A borrow means that the edge is late: then on_time_mask, remaining and set_mask become 0. Otherwise
            // on_time_mask is 0xff.
            "sbc {on_time_mask}, {on_time_mask}",
            "com {on_time_mask}",
            "and {remaining}, {on_time_mask}",
            "and {set_mask}, {on_time_mask}",
            "or {value}, {set_mask}",
            // Each iteration takes three cycles; the loop ends with remaining = 253, 254 or 255. The remaining 0 to 2
            // cycles come from branches to the next instruction: two cycles if taken, one cycle if not.
            "2: subi {remaining}, 3",
            "brcc 2b",
            "cpi {remaining}, 254",
            "brcc 3f",
            "3: cpi {remaining}, 255",
            "breq 4f",
            "4: st {port}, {value}",
            tcnt1l = const 0x84,
            tcnt1h = const 0x85,
            now = out(reg) _,
            remaining = inout(reg_upper) remaining => _,
            on_time_mask = inout(reg) high => on_time_mask,
            port = in(reg_ptr) port,
            value = inout(reg) base => _,
            set_mask = inout(reg) set_mask => _,
            options(nostack),
        );
    }
    on_time_mask
}
