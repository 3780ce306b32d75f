//! Full 32-bit products of 16-bit factors.

/// Returns the full product of two unsigned factors.
#[cfg(not(target_arch = "avr"))]
pub const fn mul_unsigned(a: u16, b: u16) -> u32 {
    a as u32 * b as u32
}

/// Returns the full product of two signed factors.
#[cfg(not(target_arch = "avr"))]
pub const fn mul(a: i16, b: i16) -> i32 {
    a as i32 * b as i32
}

/// Computes the 32-bit product of two 16-bit factors, read as unsigned, as the sum of four shifted products of bytes.
/// Any instructions `$correction` then correct the halves `low` and `high`. Takes half the cycles of the library
/// routine that the compiler would call, which multiplies 32 by 32 bits.
#[cfg(target_arch = "avr")]
macro_rules! product {
    ($a:expr, $b:expr $(, $correction:literal)*) => {{
        let low: u16;
        let high: u16;
        // SAFETY: the instructions change only registers, and set r1 to zero again, as the calling convention requires.
        unsafe {
            core::arch::asm!(
                "mul {a:l}, {b:l}",
                "movw {low}, r0",
                "mul {a:h}, {b:h}",
                "movw {high}, r0",
                "mul {a:h}, {b:l}",
                "add {low:h}, r0",
                "adc {high:l}, r1",
                "clr {zero}",
                "adc {high:h}, {zero}",
                "mul {a:l}, {b:h}",
                "add {low:h}, r0",
                "adc {high:l}, r1",
                "adc {high:h}, {zero}",
                "clr r1",
                $($correction,)*
                a = in(reg_pair) $a,
                b = in(reg_pair) $b,
                low = out(reg_pair) low,
                high = out(reg_pair) high,
                zero = out(reg) _,
                options(pure, nomem, nostack),
            );
        }
        u32::from(high) << 16 | u32::from(low)
    }};
}

/// Returns the full product of two unsigned factors.
#[cfg(target_arch = "avr")]
#[inline(never)]
pub fn mul_unsigned(a: u16, b: u16) -> u32 {
    product!(a, b)
}

/// Returns the full product of two signed factors. A negative factor, read as unsigned, is 2^16 too large; for each
/// such factor, the other factor is subtracted from the upper half.
#[cfg(target_arch = "avr")]
#[inline(never)]
pub fn mul(a: i16, b: i16) -> i32 {
    product!(
        a,
        b,
        "sbrs {a:h}, 7",
        "rjmp 2f",
        "sub {high:l}, {b:l}",
        "sbc {high:h}, {b:h}",
        "2:",
        "sbrs {b:h}, 7",
        "rjmp 3f",
        "sub {high:l}, {a:l}",
        "sbc {high:h}, {a:h}",
        "3:"
    ) as i32
}
