//! Tests of the simulated supply and ADC against the data sheet: chapter 24, and sections 11.5, 11.7 and 29.5.

use super::*;

/// CPU cycles per cycle of the ADC clock at prescaler 128, which is 125 kHz.
const CYCLES_PER_ADC_CLOCK: u64 = 128;

/// Compiles a program that can use these macros: `start()` starts a conversion, `wait()` waits for its end, `show()`
/// writes the result to GPIOR0 as two marks, low byte first, and `convert()` does all three.
pub fn compile(body: &str) -> Image {
    compile_with_headers(&format!(
        "#define start() (ADCSRA = 0xc7)
        #define wait() while (ADCSRA & 0x40) {{}}
        #define show() do {{ GPIOR0 = ADCL; GPIOR0 = ADCH; }} while (0)
        #define convert() do {{ start(); wait(); show(); }} while (0)
        {body}"
    ))
}

/// Returns a UNO whose main program runs these statements once, with these voltages (mV) at A0 and the following
/// pins.
fn uno_with_statements(body: &str, pin_mv: &[u16]) -> Uno {
    let body = format!("int main(void) {{ {body} for (;;) {{}} }}");
    let mut uno = new_uno(compile(&body));
    for (number, mv) in (0..).zip(pin_mv) {
        uno.set_analog_mv(Pin::a(number), *mv);
    }
    uno
}

/// Runs the UNO of [`uno_with_statements`] for a number of milliseconds, and returns it.
fn run_statements(body: &str, pin_mv: &[u16], ms: u64) -> Uno {
    let mut uno = uno_with_statements(body, pin_mv);
    uno.run_ms(ms);
    uno
}

/// Returns the conversion results that the program has shown so far.
fn conversion_results(uno: &Uno) -> Vec<u16> {
    let bytes = mark_values(uno);
    let pairs = bytes.chunks(2);
    let results = pairs.map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    results.collect()
}

/// Runs these statements once in the main program, and returns their conversion results.
fn run_for_results(body: &str, pin_mv: &[u16]) -> Vec<u16> {
    conversion_results(&run_statements(body, pin_mv, 3))
}

/// Program that measures the settled bandgap against AVcc repeatedly.
const BANDGAP_PROGRAM: &str = "int main(void) {
    ADMUX = 0x4e; ADCSRA = 0x87; _delay_ms(1);
    for (;;) convert(); }";

#[test]
fn the_bandgap_result_is_the_ratio_of_the_bandgap_to_the_supply() {
    // "ADC = VIN * 1024 / VREF" (24.7), rounded down.
    for (supply_mv, bandgap_mv) in [
        (5000.0, 1100.0),
        (3300.0, 1100.0),
        (4500.0, 1017.0),
        (2800.0, 1200.0),
    ] {
        let mut uno = new_uno(compile(BANDGAP_PROGRAM));
        uno.set_supply_mv(supply_mv);
        uno.set_bandgap_mv(bandgap_mv);
        uno.run_ms(3);
        let expected_code = (bandgap_mv * 1024.0 / supply_mv) as u16;
        let results = conversion_results(&uno);
        assert!(results.len() > 2);
        assert!(results.iter().all(|result| *result == expected_code));
    }
}

#[test]
#[should_panic(expected = "the bandgap reference must be between 1000 and 1200 mV")]
fn setting_a_bandgap_outside_the_data_sheet_range_panics() {
    new_uno(compile(BANDGAP_PROGRAM)).set_bandgap_mv(1201.0);
}

#[test]
#[should_panic(expected = "D9 is not an analogue pin")]
fn setting_the_voltage_of_a_digital_pin_panics() {
    new_uno(compile(BANDGAP_PROGRAM)).set_analog_mv(Pin::d(9), 1);
}

#[test]
fn conversion_results_match_the_data_sheet() {
    for (message, body, pin_mv, expected) in [
        (
            "each analogue pin is measured on its own channel, and a voltage above the reference reads 1023",
            "for (unsigned char i = 0; i < 6; i++) { ADMUX = 0x40 | i; convert(); }",
            &[100, 1100, 2100, 3100, 4100, 5100][..],
            &[20, 225, 430, 634, 839, 1023][..],
        ),
        (
            "ground reads 0, and half of the bandgap measured against the bandgap reads 512",
            "ADMUX = 0x4f; convert(); ADMUX = 0xc1; convert();",
            &[0, 550],
            &[0, 512],
        ),
        (
            // "Once the conversion starts, the channel and reference selection is locked to
            // ensure a sufficient sampling time for the ADC" (24.5).
            "a channel is locked once the conversion has started",
            "ADMUX = 0x40; start(); _delay_us(20); ADMUX = 0x41; wait(); show();",
            &[2500, 1250],
            &[512],
        ),
        (
            "a pin needs no settling",
            "ADMUX = 0x4e; start(); wait(); ADMUX = 0x42; start(); wait(); show();",
            &[0, 0, 2500],
            &[512],
        ),
    ] {
        assert_eq!(run_for_results(body, pin_mv), expected, "{message}");
    }
}

#[test]
fn register_values_match_the_data_sheet() {
    for (message, body, pin_mv, expected) in [
        (
            // "ADSC will read as one as long as a conversion is in progress. When the
            // conversion is complete, it returns to zero. Writing zero to this bit has no
            // effect" (24.9.2).
            "ADSC reads one as long as a conversion is in progress",
            "ADMUX = 0x40; start();
            ADCSRA = 0x87; GPIOR0 = ADCSRA & 0x50;
            wait(); GPIOR0 = ADCSRA & 0x50;
            ADCSRA = 0x97; GPIOR0 = ADCSRA & 0x50;",
            &[][..],
            &[0x40, 0x10, 0x00][..],
        ),
        (
            // "Turning the ADC off while a conversion is in progress, will terminate this
            // conversion" (24.9.2).
            "turning the ADC off ends a conversion",
            "ADMUX = 0x40; start(); ADCSRA = 7;
            GPIOR0 = ADCSRA; _delay_ms(1); GPIOR0 = ADCSRA;",
            &[],
            &[7, 7],
        ),
        (
            "a conversion is not started while the ADC is off",
            "ADCSRA = 0x47; GPIOR0 = ADCSRA;",
            &[],
            &[7],
        ),
        (
            // "if ADCL has been read, and a conversion completes before ADCH is read, neither
            // register is updated and the result from the conversion is lost" (24.2).
            "the result is locked from the read of ADCL to the read of ADCH",
            "ADMUX = 0x40; start(); wait();
            GPIOR0 = ADCL;
            ADMUX = 0x41; start(); wait();
            GPIOR0 = ADCH; GPIOR0 = ADCL; GPIOR0 = ADCH;
            start(); wait(); show();",
            &[3300, 700], // 675 = 0x2a3 and 143 = 0x08f
            &[0xa3, 0x02, 0xa3, 0x02, 0x8f, 0x00],
        ),
        (
            // "Changing the ADLAR bit will affect the ADC Data Register immediately,
            // regardless of any ongoing conversions" (24.9.1); ADCH alone then holds 8 bits.
            "ADLAR shifts the result at once",
            "ADMUX = 0x40; start(); wait(); ADMUX = 0x60;
            GPIOR0 = ADCH; GPIOR0 = ADCL; GPIOR0 = ADCH;",
            &[3300], // 675 = 0x2a3 = 10 1010 0011
            &[0xa8, 0xc0, 0xa8],
        ),
    ] {
        let uno = run_statements(body, pin_mv, 2);
        assert_eq!(mark_values(&uno), expected, "{message}");
    }
}

#[test]
fn the_first_conversion_takes_25_clocks_and_later_conversions_take_13() {
    // Table 24-1: "First conversion 25", "Normal conversions, single ended 13".
    // A conversion "starts at the following rising edge of the ADC clock", so it may take up to one clock more.
    let uno = run_statements(
        "ADMUX = 0x40; ADCSRA = 0x87;
        for (unsigned char i = 0; i < 3; i++) { start(); GPIOR0 = i; wait(); GPIOR0 = i; }
        ADCSRA = 7; ADCSRA = 0x87;
        start(); GPIOR0 = 9; wait(); GPIOR0 = 9;",
        &[],
        2,
    );
    let lengths = intervals(&mark_cycles(&uno));
    for (length, clocks) in lengths.into_iter().step_by(2).zip([25, 13, 13, 25]) {
        let range = clocks * CYCLES_PER_ADC_CLOCK - 4..(clocks + 1) * CYCLES_PER_ADC_CLOCK + 12;
        let is_expected = range.contains(&length);
        assert!(is_expected, "{length} cycles, expected {clocks} clocks");
    }
}

#[test]
fn the_prescaler_divides_as_in_table_24_5() {
    // ADPS 000 and 001: 2, 010: 4, ... 111: 128.
    for (adps, divisor) in [2, 2, 4, 8, 16, 32, 64, 128].into_iter().enumerate() {
        let body = format!(
            "ADMUX = 0x40; ADCSRA = 0xa0 | {adps}; ADCSRA |= 0x40;
            for (;;) {{ while (!(ADCSRA & 0x10)) {{}} GPIOR0 = 1; ADCSRA |= 0x10; }}"
        );
        let cycles = mark_cycles(&run_statements(&body, &[], 2));
        let count = cycles.len() as u64 - 2;
        let (first_cycle, last_cycle) = (cycles[1], cycles[cycles.len() - 1]);
        // Free running: "a new conversion will be started immediately". With the smallest divisors, the program's
        // loop is slower than a conversion.
        let is_expected = match divisor {
            8.. => (last_cycle - first_cycle).abs_diff(count * 13 * divisor) < 40,
            _ => count > 500,
        };
        assert!(is_expected, "divisor {divisor}: {cycles:?}");
    }
}

#[test]
fn the_two_lowest_prescaler_settings_divide_by_two() {
    // Table 24-5: 13 clocks are 26 cycles.
    for adps in [0, 1] {
        let body = format!(
            "ADMUX = 0x40; ADCSRA = 0xc0 | {adps}; wait();
            ADCSRA = 0xc0 | {adps}; __builtin_avr_delay_cycles(18); GPIOR0 = ADCSRA & 0x40;
            ADCSRA = 0xc0 | {adps}; __builtin_avr_delay_cycles(40); GPIOR0 = ADCSRA & 0x40;"
        );
        let uno = run_statements(&body, &[], 1);
        assert_eq!(mark_values(&uno), [0x40, 0], "ADPS {adps}");
    }
}

#[test]
fn the_adc_interrupt_wakes_the_cpu_and_clears_its_flag() {
    let mut uno = new_uno(compile("ISR(ADC_vect) { GPIOR0 = ADCSRA; show(); }
        int main(void) { SMCR = 1; ADMUX = 0x40; ADCSRA = 0xcf; sei(); for (;;) asm volatile (\"sleep\"); }"));
    uno.set_analog_mv(Pin::a(0), 2500);
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), [0x8f, 0x00, 0x02]);
    assert!(uno.sleep_cycles() > 15_000);
}

#[test]
fn a_voltage_is_sampled_at_the_clock_in_table_24_1() {
    // "Sample & Hold (Cycles from Start of Conversion)": 1.5 clocks, in the first conversion 13.5. A conversion
    // starts at the next clock edge, at most one clock after ADSC is set.
    let later_conversion = "start(); wait(); GPIOR0 = 0; start(); wait(); show();";
    for (body, sampled_change_clock, missed_change_clock) in
        [(later_conversion, 1, 3), ("GPIOR0 = 0; convert();", 13, 15)]
    {
        let result_after = |change_clock: u64| {
            let mut uno = uno_with_statements(&format!("ADMUX = 0x40; {body}"), &[]);
            uno.run_until(CYCLES_PER_MS, 1, |uno| !uno.marks().is_empty());
            uno.take_marks();
            uno.run_cycles(change_clock * CYCLES_PER_ADC_CLOCK);
            uno.set_analog_mv(Pin::a(0), 2500);
            uno.run_ms(1);
            conversion_results(&uno)[0]
        };
        let results = [sampled_change_clock, missed_change_clock].map(result_after);
        assert_eq!(results, [512, 0], "{body}");
    }
}

#[test]
fn conversions_end_a_whole_number_of_adc_clocks_apart() {
    // "the conversion starts at the following rising edge of the ADC clock cycle" (24.4): the ends of any two
    // conversions are a whole number of clocks apart.
    let uno = run_statements(
        "ADMUX = 0x40; start();
        for (unsigned char i = 0; i < 20; i++) {
            while (!(ADCSRA & 0x10)) {}
            GPIOR0 = i;
            for (unsigned char j = 0; j < i; j++) _delay_us(3);
            ADCSRA = 0xd7;
        }",
        &[],
        4,
    );
    let cycles = mark_cycles(&uno);
    assert_eq!(cycles.len(), 20);
    for cycle in &cycles {
        let error = (cycle - cycles[0] + 10) % CYCLES_PER_ADC_CLOCK;
        assert!(error <= 20, "{cycles:?}");
    }
}

#[test]
fn the_bandgap_needs_70_us_after_the_channel_is_selected() {
    // "When the bandgap reference voltage is used as input to the ADC, it will take
    // a certain time for the voltage to stabilize. If not stabilized, the first
    // value read after the first conversion may be wrong"; 29.5: start-up
    // time at most 70 us.
    let results_after = |wait_us: u32, previous_mv: u16| {
        let body = format!(
            "ADMUX = 0x40; start(); wait(); _delay_ms(1);
            ADMUX = 0x4e; _delay_us({wait_us});
            start(); wait(); show(); start(); wait(); show();"
        );
        run_for_results(&body, &[previous_mv])
    };
    assert_eq!(results_after(72, 0), [225, 225]);
    let early_results = results_after(30, 0);
    assert!((80..160).contains(&early_results[0]), "{early_results:?}");
    assert_eq!(early_results[1], 225, "the second conversion is correct");
    assert!(
        results_after(30, 5000)[0] > 400,
        "the result is between the previous channel and the bandgap"
    );
}

#[test]
fn the_bandgap_has_settled_after_70_us_but_not_earlier() {
    // With an ADC clock of 1 MHz, the start of a conversion is known to a microsecond.
    let first_result_after = |wait_us: u32| {
        let body = format!(
            "ADMUX = 0x40; ADCSRA = 0xc4; wait();
            ADMUX = 0x4e; _delay_us({wait_us}); ADCSRA = 0xc4; wait(); show();"
        );
        run_for_results(&body, &[5000])[0]
    };
    assert!((226..250).contains(&first_result_after(68)));
    assert_eq!(first_result_after(71), 225);
}

#[test]
fn the_bandgap_needs_70_us_after_the_adc_is_switched_on() {
    // "after ... enabling the ADC, the user must always allow the reference to start
    // up before the output ... is used" (11.7.1).
    let first_result_after = |wait_us: u32| {
        let body = format!(
            "ADMUX = 0x4e; _delay_ms(1); ADCSRA = 0x87; _delay_us({wait_us});
            start(); wait(); show();"
        );
        run_for_results(&body, &[])[0]
    };
    assert_eq!(first_result_after(72), 225);
    assert_ne!(first_result_after(20), 225);
}

#[test]
fn a_reset_clears_the_registers_of_the_adc() {
    let mut uno = uno_with_statements(
        "GPIOR0 = ADCSRA; GPIOR0 = ADMUX; GPIOR0 = ADCL; GPIOR0 = ADCH;
        ADMUX = 0x40; start(); wait(); GPIOR0 = ADCL; start();",
        &[2500],
    );
    uno.run_cycles(30 * CYCLES_PER_ADC_CLOCK);
    uno.reset();
    uno.take_marks();
    uno.run_ms(1);
    assert_eq!(mark_values(&uno)[..4], [0; 4]);
}

#[test]
fn a_supply_ramp_is_linear_and_the_adc_follows_it() {
    let mut uno = uno_after_ms(2, compile(BANDGAP_PROGRAM));
    uno.ramp_supply_mv(3000.0, 100 * CYCLES_PER_MS);
    uno.run_ms(50);
    assert!((uno.supply_mv() - 4000.0).abs() < 1e-6);
    uno.run_ms(70);
    assert!((uno.supply_mv() - 3000.0).abs() < 1e-6);
    let results = conversion_results(&uno);
    assert!(results.is_sorted());
    assert_eq!((results[0], results[results.len() - 1]), (225, 375));
    for code in 226..375 {
        assert!(results.contains(&code), "code {code}: {results:?}");
    }
}

#[test]
fn stock_simavr_measures_a_low_supply_but_does_not_reset() {
    let mut uno = Uno::with_image(compile(BANDGAP_PROGRAM), Fidelity::Stock);
    run_at_supply(&mut uno, 2500.0, 3);
    assert_eq!(conversion_results(&uno)[1], 450);
    assert!(!uno.is_held_in_reset());
    run_at_supply(&mut uno, 1000.0, 1);
    assert!(!uno.is_held_in_reset());
    assert_eq!(reset_causes(&uno), [PowerOn]);
}
