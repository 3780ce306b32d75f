//! A smooth function of a squared length, read from a table in flash.
//!
//! Computing a root and a quotient would take 2 800 cycles in every frame. The five-bar's functions depend on a single
//! squared length, so a table is sufficient. The table has sixteen steps per octave of the argument (a range from a
//! number to its double), and interpolates the function linearly within a step. For any argument, a square root is then
//! accurate to about one part in ten thousand, and a reciprocal to about one part in a thousand.

use lizard_avr::{Flash, mul_unsigned};

/// The number of steps in an octave of the argument.
const STEPS_PER_OCTAVE: usize = 16;

/// The number of octaves in a table below the octave of the largest argument.
pub const OCTAVE_COUNT: u32 = 10;

/// The number of entries in a table: one for the start of each step, and one for the end of the last octave.
pub const ENTRY_COUNT: usize = STEPS_PER_OCTAVE * (OCTAVE_COUNT as usize + 1) + 1;

/// The table of a function, indexed by step.
pub type Table = [i16; ENTRY_COUNT];

/// A function that is read from a table in flash.
#[derive(Clone, Copy)]
pub struct Curve<'a> {
    table: Flash<'a, Table>,
    /// The number of leading zeros of an argument in the first octave.
    first_octave_zeros: u8,
}

impl<'a> Curve<'a> {
    /// Creates the curve of the function in `table`, which is defined up to an argument with `zeros` leading zeros.
    pub const fn with_leading_zeros(table: Flash<'a, Table>, zeros: u16) -> Self {
        Self {
            table,
            first_octave_zeros: (zeros + OCTAVE_COUNT as u16) as u8,
        }
    }

    /// Returns the value of a non-increasing function, rounded up. Returns `None` below the table's first octave,
    /// which begins at 1/1024 of the start of the largest argument's octave.
    pub fn at_rounded_up(&self, argument: u32) -> Option<i16> {
        self.interpolate(argument, 0)
    }

    /// Returns the value of any function, rounded to nearest. Returns `None` below the table's first octave, see
    /// [`Curve::at_rounded_up`].
    pub fn at(&self, argument: u32) -> Option<i16> {
        self.interpolate(argument, 0x8000)
    }

    /// Interpolates the value. The step from the entry below the argument to the value is computed with 16 fractional
    /// bits; `rounding` is added before they are dropped.
    #[inline(never)]
    fn interpolate(&self, argument: u32, rounding: u16) -> Option<i16> {
        let mut mantissa = argument;
        let mut octave = self.first_octave_zeros;
        while mantissa < 1 << 31 {
            mantissa <<= 1;
            octave = octave.checked_sub(1)?;
        }
        // Bits below the leading one: four for the step, then sixteen for the position within the step.
        let step = (mantissa >> 24) as u8 >> 3 & (STEPS_PER_OCTAVE as u8 - 1);
        let fraction = ((mantissa << 5) >> 16) as u16;
        let index = usize::from(octave) * STEPS_PER_OCTAVE + usize::from(step);
        let entry = self.table.at(index).load();
        let next_entry = self.table.at(index + 1).load();
        let change =
            (mul_unsigned(next_entry.abs_diff(entry), fraction) + u32::from(rounding)) >> 16;
        Some(if next_entry < entry {
            entry.wrapping_sub(change as i16)
        } else {
            entry.wrapping_add(change as i16)
        })
    }
}

/// Returns the argument of the table entry at `index`, for a largest argument of `max_argument`. The result is rounded
/// down, but is exact if `max_argument` is at least 16384.
pub const fn argument_at(max_argument: u32, index: usize) -> u64 {
    let first_octave_zeros = (max_argument.leading_zeros() + OCTAVE_COUNT) as usize;
    let octave = index / STEPS_PER_OCTAVE;
    match (31 + octave).checked_sub(first_octave_zeros) {
        Some(leading_bit) => {
            ((STEPS_PER_OCTAVE + index % STEPS_PER_OCTAVE) as u64) << leading_bit >> 4
        }
        None => 0,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Makes the table of `function`, whose argument is a fraction of the largest argument.
    fn make_table(max_argument: u32, function: impl Fn(f64) -> f64) -> Table {
        core::array::from_fn(|index| {
            let fraction = argument_at(max_argument, index) as f64 / f64::from(max_argument);
            function(fraction).round().clamp(-32767.0, 32767.0) as i16
        })
    }

    /// Creates the curve of the function in `table`, which is defined up to `max_argument`.
    fn make_curve(table: &Table, max_argument: u32) -> Curve<'_> {
        Curve::with_leading_zeros(Flash::from(table), max_argument.leading_zeros() as u16)
    }

    /// Falling functions that fill the table: a logarithm, a negative root, and a straight line.
    const FUNCTIONS: [fn(f64) -> f64; 3] = [
        |u| -2900.0 * u.log2(),
        |u| -20_000.0 * u.sqrt(),
        |u| 10_000.0 - 12_000.0 * u,
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_curve_follows_its_function_in_every_octave(
            max_argument in (10u32..32, any::<u32>())
                .prop_map(|(bits, low)| (1 << bits) | (low & ((1 << bits) - 1))),
            octave in 0u32..=OCTAVE_COUNT,
            octave_fraction in 0.5..=1.0f64,
            function_index in 0usize..3,
        ) {
            let function = FUNCTIONS[function_index];
            let table = make_table(max_argument, function);
            let curve = make_curve(&table, max_argument);
            let argument = (f64::from(max_argument >> octave) * octave_fraction) as u32;
            if argument < (max_argument >> OCTAVE_COUNT).max(1) {
                return Ok(());
            }
            let exact = function(f64::from(argument) / f64::from(max_argument));
            let actual = f64::from(curve.at(argument).expect("the argument is within the octaves"));
            // Within a step of 1/16 octave, the logarithm and the root differ from a straight line by at most 1.9 and
            // 2.3. Two roundings add to this difference.
            prop_assert!((actual - exact).abs() <= 4.0, "{argument} of {max_argument}: {actual}, exactly {exact}");
        }

        #[test]
        fn an_entry_is_read_exactly_at_its_argument(
            // For a smaller `max_argument`, not all sixteen steps of the first octaves are whole numbers.
            max_argument in 1u32 << 14..,
            index in 0..ENTRY_COUNT,
        ) {
            let table: Table = core::array::from_fn(|index| 5000 - 50 * index as i16);
            let curve = make_curve(&table, max_argument);
            let entry_argument = argument_at(max_argument, index);
            if (u64::from(max_argument >> OCTAVE_COUNT)..=max_argument.into()).contains(&entry_argument) {
                prop_assert_eq!(curve.at(entry_argument as u32), Some(table[index]));
            }
        }
    }

    #[test]
    fn between_two_entries_any_function_is_rounded_to_nearest() {
        for slope in [-5, 5] {
            let table: Table = core::array::from_fn(|index| slope * index as i16);
            let curve = make_curve(&table, 1 << 20);
            // In the last octave, the distance between entries is 1/16 of the octave.
            for argument in (1 << 20..1 << 21).step_by(997) {
                let octaves = f64::from(argument) / f64::from(1 << 20) - 1.0;
                let exact = f64::from(slope) * 16.0 * (f64::from(OCTAVE_COUNT) + octaves);
                let actual = curve.at(argument).map(f64::from);
                let actual = actual.expect("the argument is within the octaves");
                let error = (actual - exact).abs();
                assert!(error <= 0.501, "{argument}: {actual}, exactly {exact}");
            }
        }
    }

    #[test]
    fn a_curve_has_no_value_below_its_first_octave() {
        let table = [7; ENTRY_COUNT];
        for max_argument in [0, 1, 1023, 1024, 5000, 1 << 20, u32::MAX] {
            let curve = make_curve(&table, max_argument);
            // The table covers the entire octave that contains 1/1024 of the largest argument.
            let min_argument: u32 = (max_argument >> OCTAVE_COUNT)
                .checked_ilog2()
                .map_or(0, |octave| 1 << octave);
            assert_eq!(curve.at(0), None);
            assert_eq!(curve.at(min_argument.saturating_sub(1)), None);
            assert_eq!(curve.at(min_argument.max(1)), Some(7));
        }
    }

    #[test]
    fn entry_arguments_never_decrease_and_are_at_most_twice_the_largest_argument() {
        for max_argument in [0, 1, 100, 1023, 1024] {
            for index in 1..ENTRY_COUNT {
                let previous_argument = argument_at(max_argument, index - 1);
                assert!(previous_argument <= argument_at(max_argument, index));
                assert!(previous_argument <= 2 * u64::from(max_argument));
            }
        }
    }
}
