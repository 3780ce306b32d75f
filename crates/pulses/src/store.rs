//! A store to a port at a chosen cycle.

use core::arch::asm;

/// Stores `low | change` in `port` a fixed number of cycles after Timer1 reaches `count` (low
/// byte first), and returns 0xff. If that count has passed, stores `low` at once and returns 0.
///
/// A falling edge calls it with a `change` of 0: the instructions are the same as for a rising edge, so the time they
/// take cancels out of the width.
///
/// # Safety
/// `port` is the PORT register of a servo pin. `low` has the right levels for its other pins until
/// the store, so interrupts are off. `count` is at most 255 cycles ahead.
#[inline(always)]
pub unsafe fn store_at(count: [u8; 2], port: *mut u8, low: u8, change: u8) -> u8 {
    let [left, high] = count;
    let on_time: u8;
    // SAFETY: reads TCNT1 (low byte first, which latches the high one), and
    // writes `port`, for which the caller is responsible.
    unsafe {
        asm!(
            // left = count - now
            "lds {now}, {tcnt1l}",
            "sub {left}, {now}",
            "lds {now}, {tcnt1h}",
            "sbc {on_time}, {now}",
            // A borrow means that the edge is late: then on_time, left and change become 0.
            // Otherwise on_time is 0xff.
            "sbc {on_time}, {on_time}",
            "com {on_time}",
            "and {left}, {on_time}",
            "and {change}, {on_time}",
            "or {value}, {change}",
            // Each turn of the loop takes three cycles; it ends with left = 253, 254 or
            // 255. The other 0 to 2 cycles come from branches to the next instruction:
            // two cycles if taken, one if not.
            "2: subi {left}, 3",
            "brcc 2b",
            "cpi {left}, 254",
            "brcc 3f",
            "3: cpi {left}, 255",
            "breq 4f",
            "4: st {port}, {value}",
            tcnt1l = const 0x84,
            tcnt1h = const 0x85,
            now = out(reg) _,
            left = inout(reg_upper) left => _,
            on_time = inout(reg) high => on_time,
            port = in(reg_ptr) port,
            value = inout(reg) low => _,
            change = inout(reg) change => _,
            options(nostack),
        );
    }
    on_time
}
