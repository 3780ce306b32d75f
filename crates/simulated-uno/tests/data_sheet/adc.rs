//! The simulated supply and ADC against the data sheet, chapters 11.5 and 24.

use simulated_uno::avr_gcc::c;
use simulated_uno::{CYCLES_PER_MS, Fidelity, Image, Pin, ResetCause, Uno};

use super::{causes, marks};

/// ADC clock of 125 kHz: prescaler 128.
const CLOCK: u64 = 128;

/// `convert()` runs one conversion and `show()` marks its result, low byte first.
fn program(body: &str) -> Image {
    c(&format!(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        #include <util/delay.h>
        #define start() (ADCSRA = 0xc7)
        #define wait() while (ADCSRA & 0x40) {{}}
        #define show() do {{ GPIOR0 = ADCL; GPIOR0 = ADCH; }} while (0)
        #define convert() do {{ start(); wait(); show(); }} while (0)
        {body}"
    ))
}

/// The program, corrected towards the data sheet.
pub fn with(body: &str) -> Uno {
    Uno::with_image(program(body), Fidelity::DataSheet)
}

/// The results shown so far.
fn results(uno: &Uno) -> Vec<u16> {
    let bytes = marks(uno);
    bytes
        .chunks(2)
        .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
        .collect()
}

/// Measures the bandgap against AVcc, settled, again and again.
const BANDGAP: &str = "int main(void) {
    ADMUX = 0x4e; ADCSRA = 0x87; _delay_ms(1);
    for (;;) convert(); }";

#[test]
fn the_bandgap_against_avcc_tells_the_supply() {
    // "ADC = VIN * 1024 / VREF" (24.7), whole part.
    for (supply, bandgap) in [
        (5000.0, 1100.0),
        (3300.0, 1100.0),
        (4500.0, 1017.0),
        (2800.0, 1200.0),
    ] {
        let mut uno = with(BANDGAP);
        uno.set_supply_mv(supply);
        uno.set_bandgap_mv(bandgap);
        uno.run_ms(3);
        let expected = (bandgap * 1024.0 / supply) as u16;
        assert!(results(&uno).len() > 2);
        assert!(results(&uno).iter().all(|result| *result == expected));
    }
}

#[test]
#[should_panic(expected = "a bandgap reference has 1000 to 1200 mV")]
fn a_bandgap_beyond_the_data_sheet_is_refused() {
    with(BANDGAP).set_bandgap_mv(1201.0);
}

#[test]
fn each_analogue_pin_is_measured_on_its_own_channel() {
    let mut uno = with(
        "int main(void) {
        for (unsigned char i = 0; i < 6; i++) { ADMUX = 0x40 | i; convert(); }
        for (;;) {} }",
    );
    for n in 0..6 {
        uno.set_analog_mv(Pin::a(n), 100 + 1000 * u16::from(n));
    }
    uno.run_ms(3);
    let expected: Vec<u16> = (0..6u32)
        .map(|n| ((100 + 1000 * n) * 1024 / 5000).min(1023) as u16)
        .collect();
    assert_eq!(results(&uno), expected);
}

#[test]
#[should_panic(expected = "D9 is not an analogue pin")]
fn a_digital_pin_has_no_voltage_to_set() {
    with(BANDGAP).set_analog_mv(Pin::d(9), 1);
}

#[test]
fn ground_reads_zero_and_too_much_reads_1023() {
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x4f; convert();
        ADMUX = 0xc1; convert();
        ADMUX = 0xce; convert();
        for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(1), 550);
    uno.run_ms(3);
    // Against the bandgap: half of it, and itself.
    assert_eq!(results(&uno)[..2], [0, 512]);
    let mut uno = with("int main(void) { ADMUX = 0x41; convert(); for (;;) {} }");
    uno.set_analog_mv(Pin::a(1), 6000);
    uno.run_ms(1);
    assert_eq!(results(&uno), [1023]);
}

#[test]
fn the_first_conversion_takes_25_clocks_and_others_13() {
    // Table 24-1: "First conversion 25", "Normal conversions, single ended 13".
    // It "starts at the following rising edge of the ADC clock", so up to one more.
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; ADCSRA = 0x87;
        for (unsigned char i = 0; i < 3; i++) { start(); GPIOR0 = i; wait(); GPIOR0 = i; }
        ADCSRA = 7; ADCSRA = 0x87;
        start(); GPIOR0 = 9; wait(); GPIOR0 = 9;
        for (;;) {} }",
    );
    uno.run_ms(2);
    let cycles: Vec<u64> = uno.marks().iter().map(|mark| mark.cycle).collect();
    let took: Vec<u64> = cycles.chunks(2).map(|pair| pair[1] - pair[0]).collect();
    for (took, clocks) in took.into_iter().zip([25, 13, 13, 25]) {
        let range = clocks * CLOCK - 4..(clocks + 1) * CLOCK + 12;
        assert!(range.contains(&took), "{took}, not {clocks} clocks");
    }
}

#[test]
fn the_prescaler_divides_by_table_24_5() {
    // ADPS 000 and 001: 2, 010: 4, ... 111: 128.
    for (select, divisor) in [2, 2, 4, 8, 16, 32, 64, 128].into_iter().enumerate() {
        let body = format!(
            "int main(void) {{
            ADMUX = 0x40; ADCSRA = 0xa0 | {select}; ADCSRA |= 0x40;
            for (;;) {{ while (!(ADCSRA & 0x10)) {{}} GPIOR0 = 1; ADCSRA |= 0x10; }} }}"
        );
        let mut uno = with(&body);
        uno.run_ms(2);
        let cycles: Vec<u64> = uno.marks().iter().map(|mark| mark.cycle).collect();
        let (first, last, count) = (cycles[1], cycles[cycles.len() - 1], cycles.len() as u64 - 2);
        if divisor >= 8 {
            // Free running: "a new conversion will be started immediately".
            assert!(
                (last - first).abs_diff(count * 13 * divisor) < 40,
                "{divisor}"
            );
        } else {
            assert!(count > 500, "{divisor}");
        }
    }
}

#[test]
fn the_lowest_prescalers_both_divide_by_two() {
    // Table 24-5: 13 clocks are 26 cycles.
    for select in [0, 1] {
        let mut uno = with(&format!(
            "int main(void) {{
            ADMUX = 0x40; ADCSRA = 0xc0 | {select}; wait();
            ADCSRA = 0xc0 | {select}; __builtin_avr_delay_cycles(18); GPIOR0 = ADCSRA & 0x40;
            ADCSRA = 0xc0 | {select}; __builtin_avr_delay_cycles(40); GPIOR0 = ADCSRA & 0x40;
            for (;;) {{}} }}"
        ));
        uno.run_ms(1);
        assert_eq!(marks(&uno), [0x40, 0], "{select}");
    }
}

#[test]
fn adsc_reads_one_as_long_as_a_conversion_is_in_progress() {
    // "ADSC will read as one as long as a conversion is in progress. When the
    // conversion is complete, it returns to zero. Writing zero to this bit has no
    // effect" (24.9.2).
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start();
        ADCSRA = 0x87; GPIOR0 = ADCSRA & 0x50;
        wait(); GPIOR0 = ADCSRA & 0x50;
        ADCSRA = 0x97; GPIOR0 = ADCSRA & 0x50;
        for (;;) {} }",
    );
    uno.run_ms(1);
    assert_eq!(marks(&uno), [0x40, 0x10, 0x00]);
}

#[test]
fn turning_the_adc_off_ends_a_conversion() {
    // "Turning the ADC off while a conversion is in progress, will terminate this
    // conversion" (24.9.2).
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start(); ADCSRA = 7;
        GPIOR0 = ADCSRA; _delay_ms(1); GPIOR0 = ADCSRA;
        for (;;) {} }",
    );
    uno.run_ms(2);
    assert_eq!(marks(&uno), [7, 7]);
}

#[test]
fn a_conversion_is_not_started_while_the_adc_is_off() {
    let mut uno = with("int main(void) { ADCSRA = 0x47; GPIOR0 = ADCSRA; for (;;) {} }");
    uno.run_ms(1);
    assert_eq!(marks(&uno), [7]);
}

#[test]
fn the_result_is_locked_from_adcl_to_adch() {
    // "if ADCL has been read, and a conversion completes before ADCH is read, neither
    // register is updated and the result from the conversion is lost" (24.2).
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start(); wait();
        GPIOR0 = ADCL;
        ADMUX = 0x41; start(); wait();
        GPIOR0 = ADCH; GPIOR0 = ADCL; GPIOR0 = ADCH;
        start(); wait(); show();
        for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(0), 3300); // 675 = 0x2a3
    uno.set_analog_mv(Pin::a(1), 700); // 143 = 0x08f
    uno.run_ms(2);
    assert_eq!(marks(&uno), [0xa3, 0x02, 0xa3, 0x02, 0x8f, 0x00]);
}

#[test]
fn adlar_shifts_the_result_at_once() {
    // "Changing the ADLAR bit will affect the ADC Data Register immediately,
    // regardless of any ongoing conversions" (24.9.1); ADCH alone then holds 8 bits.
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start(); wait(); ADMUX = 0x60;
        GPIOR0 = ADCH; GPIOR0 = ADCL; GPIOR0 = ADCH;
        for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(0), 3300); // 675 = 0x2a3 = 10 1010 0011
    uno.run_ms(1);
    assert_eq!(marks(&uno), [0xa8, 0xc0, 0xa8]);
}

#[test]
fn the_adc_interrupt_wakes_the_cpu_and_clears_its_flag() {
    let mut uno = with("ISR(ADC_vect) { GPIOR0 = ADCSRA; show(); }
        int main(void) { SMCR = 1; ADMUX = 0x40; ADCSRA = 0xcf; sei(); for (;;) asm volatile (\"sleep\"); }");
    uno.set_analog_mv(Pin::a(0), 2500);
    uno.run_ms(1);
    assert_eq!(marks(&uno), [0x8f, 0x00, 0x02]);
    assert!(uno.asleep_cycles() > 15_000);
}

#[test]
fn a_channel_is_locked_once_the_conversion_has_started() {
    // "Once the conversion starts, the channel and reference selection is locked to
    // ensure a sufficient sampling time for the ADC" (24.5).
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start(); _delay_us(20); ADMUX = 0x41; wait(); show();
        for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(0), 2500);
    uno.set_analog_mv(Pin::a(1), 1250);
    uno.run_ms(1);
    assert_eq!(results(&uno), [512]);
}

#[test]
fn a_voltage_is_sampled_one_and_a_half_clocks_after_the_start() {
    // Table 24-1, "Sample & Hold (Cycles from Start of Conversion)": 1.5.
    let body = "int main(void) {
        ADMUX = 0x40; start(); wait(); GPIOR0 = 0;
        start(); wait(); show();
        for (;;) {} }";
    let at = |change: u64| {
        let mut uno = with(body);
        uno.run_until(CYCLES_PER_MS, 1, |uno| !uno.marks().is_empty());
        uno.take_marks();
        uno.run_cycles(change);
        uno.set_analog_mv(Pin::a(0), 2500);
        uno.run_ms(1);
        results(&uno)[0]
    };
    // The start is the next edge, at most a clock after ADSC.
    assert_eq!(at(CLOCK), 512);
    assert_eq!(at(3 * CLOCK), 0);
}

#[test]
fn the_first_conversion_samples_after_13_and_a_half_clocks() {
    // Table 24-1, "First conversion": sample & hold after 13.5 cycles.
    let at = |change: u64| {
        let mut uno = with("int main(void) { ADMUX = 0x40; GPIOR0 = 0; convert(); for (;;) {} }");
        uno.run_until(CYCLES_PER_MS, 1, |uno| !uno.marks().is_empty());
        uno.take_marks();
        uno.run_cycles(change);
        uno.set_analog_mv(Pin::a(0), 2500);
        uno.run_ms(1);
        results(&uno)[0]
    };
    assert_eq!(at(13 * CLOCK), 512);
    assert_eq!(at(15 * CLOCK), 0);
}

#[test]
fn conversions_keep_step_with_the_adc_clock() {
    // "the conversion starts at the following rising edge of the ADC clock cycle"
    // (24.4): whenever it is asked for, its end is a whole number of clocks away
    // from another's.
    let mut uno = with(
        "int main(void) {
        ADMUX = 0x40; start();
        for (unsigned char i = 0; i < 20; i++) {
            while (!(ADCSRA & 0x10)) {}
            GPIOR0 = i;
            for (unsigned char j = 0; j < i; j++) _delay_us(3);
            ADCSRA = 0xd7;
        }
        for (;;) {} }",
    );
    uno.run_ms(4);
    let cycles: Vec<u64> = uno.marks().iter().map(|mark| mark.cycle).collect();
    assert_eq!(cycles.len(), 20);
    for cycle in &cycles {
        let off = (cycle - cycles[0] + 10) % CLOCK;
        assert!(off <= 20, "{cycles:?}");
    }
}

#[test]
fn the_bandgap_needs_70_us_after_the_channel_is_chosen() {
    // "When the bandgap reference voltage is used as input to the ADC, it will take
    // a certain time for the voltage to stabilize. If not stabilized, the first
    // value read after the first conversion may be wrong"; 29.5: start-up
    // time at most 70 us.
    let first = |wait: u32, before: u16| {
        let body = format!(
            "int main(void) {{
            ADMUX = 0x40; start(); wait(); _delay_ms(1);
            ADMUX = 0x4e; _delay_us({wait});
            start(); wait(); show(); start(); wait(); show();
            for (;;) {{}} }}"
        );
        let mut uno = with(&body);
        uno.set_analog_mv(Pin::a(0), before);
        uno.run_ms(3);
        results(&uno)
    };
    assert_eq!(first(72, 0), [225, 225]);
    let hasty = first(30, 0);
    assert!((80..160).contains(&hasty[0]), "{hasty:?}");
    assert_eq!(hasty[1], 225, "a second one is right");
    assert!(first(30, 5000)[0] > 400, "from the channel before");
}

#[test]
fn the_bandgap_has_settled_after_70_us_and_not_before() {
    // ADC clock of 1 MHz, so that the start is known to a microsecond.
    let first = |wait: u32| {
        let body = format!(
            "int main(void) {{
            ADMUX = 0x40; ADCSRA = 0xc4; wait();
            ADMUX = 0x4e; _delay_us({wait}); ADCSRA = 0xc4; wait(); show();
            for (;;) {{}} }}"
        );
        let mut uno = with(&body);
        uno.set_analog_mv(Pin::a(0), 5000);
        uno.run_ms(1);
        results(&uno)[0]
    };
    assert!((226..250).contains(&first(68)));
    assert_eq!(first(71), 225);
}

#[test]
fn the_bandgap_needs_70_us_after_the_adc_is_switched_on() {
    // "after ... enabling the ADC, the user must always allow the reference to start
    // up before the output ... is used" (11.7.1).
    let first = |wait: u32| {
        let body = format!(
            "int main(void) {{
            ADMUX = 0x4e; _delay_ms(1); ADCSRA = 0x87; _delay_us({wait});
            start(); wait(); show();
            for (;;) {{}} }}"
        );
        let mut uno = with(&body);
        uno.run_ms(3);
        results(&uno)[0]
    };
    assert_eq!(first(72), 225);
    assert_ne!(first(20), 225);
}

#[test]
fn a_pin_needs_no_settling() {
    let mut uno = with(
        "int main(void) { ADMUX = 0x4e; start(); wait(); ADMUX = 0x42; start(); wait(); show(); for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(2), 2500);
    uno.run_ms(1);
    assert_eq!(results(&uno), [512]);
}

#[test]
fn a_reset_switches_the_adc_off() {
    let mut uno = with(
        "int main(void) {
        GPIOR0 = ADCSRA; GPIOR0 = ADMUX; GPIOR0 = ADCL; GPIOR0 = ADCH;
        ADMUX = 0x40; start(); wait(); GPIOR0 = ADCL; start();
        for (;;) {} }",
    );
    uno.set_analog_mv(Pin::a(0), 2500);
    uno.run_cycles(30 * CLOCK);
    uno.reset();
    uno.take_marks();
    uno.run_ms(1);
    assert_eq!(marks(&uno)[..4], [0; 4]);
}

#[test]
fn a_ramp_is_a_straight_line_that_the_adc_follows() {
    let mut uno = with(BANDGAP);
    uno.run_ms(2);
    uno.ramp_supply_mv(3000.0, 100 * CYCLES_PER_MS);
    uno.run_ms(50);
    assert!((uno.supply_mv() - 4000.0).abs() < 1e-6);
    uno.run_ms(70);
    assert!((uno.supply_mv() - 3000.0).abs() < 1e-6);
    let results = results(&uno);
    assert!(results.is_sorted());
    assert_eq!((results[0], results[results.len() - 1]), (225, 375));
    for code in 226..375 {
        assert!(results.contains(&code), "{code}");
    }
}

#[test]
fn stock_simavr_measures_the_supply_too_but_is_never_reset() {
    let mut uno = Uno::with_image(program(BANDGAP), Fidelity::Stock);
    uno.set_supply_mv(2500.0);
    uno.run_ms(3);
    assert_eq!(results(&uno)[1], 450);
    assert!(!uno.held_in_reset());
    uno.set_supply_mv(1000.0);
    uno.run_ms(1);
    assert!(!uno.held_in_reset());
    assert_eq!(causes(&uno), [ResetCause::PowerOn]);
}
