//! Tests of the simulated UNO's resets against the data sheet, chapter 11.

use super::*;

/// Compiles a program that marks the value of MCUSR at each start and does not change MCUSR.
fn compile_mcusr_program() -> Image {
    compile_statements("GPIOR0 = MCUSR;")
}

/// Pulls the RESET pin low for an instant, then runs for a millisecond.
fn reset_and_run(uno: &mut Uno) {
    uno.reset();
    uno.run_ms(1);
}

#[test]
fn mcusr_accumulates_the_causes_until_power_on() {
    // "The bit is reset by a Power-on Reset, or by writing a logic zero to the flag" (11.9.1, for EXTRF, BORF and
    // WDRF).
    let mut uno = uno_after_ms(1, compile_mcusr_program());
    reset_and_run(&mut uno);
    run_at_supply(&mut uno, 2500.0, 1);
    run_at_supply(&mut uno, 5000.0, 1);
    uno.power_cycle();
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), [0x01, 0x03, 0x07, 0x01]);
    assert_eq!(reset_causes(&uno), [PowerOn, External, BrownOut, PowerOn]);
}

#[test]
fn software_can_clear_but_not_set_mcusr_flags() {
    let image = compile_statements(
        "GPIOR0 = MCUSR; MCUSR = 0x0e; GPIOR0 = MCUSR;
        MCUSR = 0x0f; GPIOR0 = MCUSR;",
    );
    let mut uno = uno_after_ms(1, image);
    reset_and_run(&mut uno);
    assert_eq!(mark_values(&uno), [1, 0, 0, 2, 2, 2]);
}

#[test]
fn mcusr_of_stock_simavr_holds_only_the_last_cause() {
    let mut uno = Uno::with_image(compile_mcusr_program(), Fidelity::Stock);
    uno.run_ms(1);
    reset_and_run(&mut uno);
    uno.power_cycle();
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), [1, 2, 1]);
}

#[test]
fn sram_and_registers_survive_every_reset_except_power_on() {
    // "During reset, all I/O Registers are set to their initial values" (11.1): SRAM and r0 to r31 are not I/O
    // registers.
    let image = assemble_loop(
        "lds r18, 0x0234
         out GPIOR0, r18
         out GPIOR0, r2
         ldi r16, 0x5a $ sts 0x0234, r16 $ mov r2, r16
         ldi r16, 0x77 $ out GPIOR1, r16 $ sts OCR1AL, r16",
    );
    for mut uno in unos_after(CYCLES_PER_MS, &image) {
        assert_eq!(uno.peek(0x4a), 0x77);
        uno.reset();
        assert_eq!(uno.peek(0x4a), 0, "GPIOR1 is an I/O register");
        uno.run_ms(1);
        assert_eq!(mark_values(&uno)[2..], [0x5a, 0x5a]);
        uno.power_cycle();
        uno.run_ms(1);
        let noise = &mark_values(&uno)[4..];
        assert!(!noise.contains(&0x5a), "{noise:?}");
    }
}

#[test]
fn power_on_fills_the_sram_with_noise_that_depends_on_the_seed() {
    let sram_after_seed = |seed: Option<u64>| {
        let mut uno = new_uno(assemble_loop(""));
        if let Some(seed) = seed {
            uno.set_noise_seed(seed);
            uno.power_cycle();
        }
        let bytes = (SRAM_START..SRAM_END).map(|address| uno.peek(address));
        bytes.collect::<Vec<u8>>()
    };
    assert_eq!(
        sram_after_seed(None),
        sram_after_seed(None),
        "without a seed, the noise is the same in every run"
    );
    assert_eq!(sram_after_seed(Some(1)), sram_after_seed(Some(1)));
    assert_ne!(sram_after_seed(Some(1)), sram_after_seed(Some(2)));
    let bytes = sram_after_seed(Some(0)).into_iter();
    let ones: u32 = bytes.map(u8::count_ones).sum();
    assert!((7_500..8_900).contains(&ones), "{ones} of 16 384 bits");
}

#[test]
fn each_power_on_changes_the_noise_and_restarts_the_stack_measurement() {
    let image = assemble_loop(
        "ldi r16, 0x08 $ out SPH, r16 $ ldi r16, 0xff $ out SPL, r16
         push r16 $ push r16 $ push r16",
    );
    let mut uno = new_uno(image);
    let first_byte = uno.peek(0x300);
    uno.run_ms(1);
    assert_eq!(uno.stack_used(), 3);
    uno.reset();
    assert_eq!(
        uno.stack_used(),
        3,
        "the stack is measured from power-on, not from the reset"
    );
    uno.power_cycle();
    assert_eq!(uno.stack_used(), 0);
    let second_byte = uno.peek(0x300);
    uno.power_cycle();
    assert!(first_byte != second_byte || second_byte != uno.peek(0x300));
}

#[test]
fn a_reset_makes_every_pin_an_input_and_ends_its_pulse() {
    // "the I/O ports of the AVR are immediately reset to their initial state when a
    // reset source goes active" (11.1).
    let image = compile_statements("DDRB = 2; PORTB = 2;");
    for mut uno in unos_after(CYCLES_PER_MS, &image) {
        assert!(uno.is_high(Pin::d(9)));
        uno.reset();
        assert!(!uno.is_high(Pin::d(9)));
        uno.run_ms(1);
        uno.cut_power(PowerCut::AtCycle(3 * CYCLES_PER_MS), 0);
        assert_eq!(*uno.run_ms(9), State::Off);
        assert!(!uno.is_high(Pin::d(9)));
        let pulses = uno.pulses(Pin::d(9));
        let [first, second] = pulses[..] else {
            panic!("expected two pulses, not {pulses:?}")
        };
        assert_eq!(first.start + first.width, CYCLES_PER_MS);
        assert!(second.start + second.width - 3 * CYCLES_PER_MS < 5);
    }
}

#[test]
fn a_timer_is_stopped_after_a_reset() {
    // Timer1 has a compare match every 1000 cycles. After the reset the program does not start Timer1, and only
    // reads its registers.
    let image = compile_statements(
        "if (MCUSR & 2) {
            OCR1A = 77; GPIOR0 = TCNT1L;
            __builtin_avr_delay_cycles(5000);
            GPIOR0 = TCNT1L; GPIOR0 = TIFR1; GPIOR0 = TCCR1B;
            for (;;) {}
        }
        OCR1A = 999; TCCR1B = 9;",
    );
    for mut uno in unos_after(CYCLES_PER_MS, &image) {
        reset_and_run(&mut uno);
        assert_eq!(mark_values(&uno), [0, 0, 0, 0]);
    }
}

#[test]
fn temp_is_cleared_by_a_reset() {
    let image = assemble_loop(
        "ldi r16, 0x12 $ sts OCR1AL, r16 $ lds r17, OCR1AH $ out GPIOR0, r17
         ldi r16, 0x34 $ sts OCR1AH, r16",
    );
    let mut uno = uno_after_ms(1, image);
    reset_and_run(&mut uno);
    assert_eq!(mark_values(&uno), [0, 0]);
}

#[test]
fn a_reset_restarts_halted_or_crashed_firmware() {
    for (source, is_halt) in [
        ("ldi r16, 1 $ out SMCR, r16 $ cli $ sleep", true),
        ("ldi r16, 1 $ sts 0x0fff, r16", false),
    ] {
        let image = assemble_loop(&format!("out GPIOR0, r1\n{source}"));
        let mut uno = uno_after_ms(1, image);
        assert_ne!(*uno.state(), State::Alive);
        assert_eq!(*uno.state() == State::Halted, is_halt, "{source}");
        uno.reset();
        assert_eq!(*uno.state(), State::Alive);
        assert_ne!(*uno.run_ms(1), State::Alive);
        assert_eq!(uno.marks().len(), 2);
    }
}

#[test]
fn a_sleeping_board_is_reset_at_the_current_cycle() {
    let image = assemble(
        "out GPIOR0, r1 $ ldi r16, 1 $ out SMCR, r16 $ sei
    end: sleep $ rjmp end",
    );
    let mut uno = uno_after(12_345, image);
    let sleep_cycles = uno.sleep_cycles();
    uno.reset();
    assert_eq!((uno.cycle(), uno.sleep_cycles()), (12_345, sleep_cycles));
    uno.run_cycles(100);
    assert_eq!(uno.marks()[1].cycle, 12_345 + 1);
}

#[test]
fn the_serial_line_continues_after_a_reset() {
    let image = compile_with_headers(
        "int main(void) {
            UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x18;
            for (;;) { while (!(UCSR0A & 0x80)) {} UDR0 = UDR0; } }",
    );
    let mut uno = uno_after_ms(1, image);
    uno.send(b"abcdefgh");
    uno.run_cycles(3 * 1389 + 700);
    uno.reset();
    uno.run_ms(3);
    // At the reset, the UNO is sending `c` back and receiving `d`, so both are lost.
    assert_eq!(transmitted_bytes(&uno), b"abefgh");
}

#[test]
fn after_a_boot_loader_mcusr_is_zero_and_the_watchdog_is_off() {
    // Optiboot: `ch = MCUSR; MCUSR = 0; if (!(ch & _BV(EXTRF))) appStart();`, and
    // appStart begins with watchdogConfig(WATCHDOG_OFF).
    let image = compile_with_headers(
        "int main(void) {
            GPIOR0 = MCUSR; GPIOR0 = WDTCSR;
            static volatile unsigned char starts __attribute__((section(\".noinit\")));
            if (GPIOR0 == 0 && starts != 0x99) { starts = 0x99; wdt_enable(WDTO_15MS); }
            for (;;) {} }",
    );
    let mut uno = new_uno(image);
    uno.set_boot_loader(true);
    uno.run_ms(60);
    uno.reset();
    uno.run_ms(20);
    uno.power_cycle();
    uno.run_cycles(1000);
    assert_eq!(mark_values(&uno), [0; 8]);
    assert_eq!(
        reset_causes(&uno),
        [PowerOn, Watchdog, External, PowerOn],
        "the simulator records the causes nevertheless"
    );
    uno.set_boot_loader(false);
    uno.reset();
    uno.run_cycles(1000);
    assert_eq!(mark_values(&uno)[8..], [2, 0]);
}

#[test]
fn a_boot_loader_can_be_removed_before_the_first_cycle() {
    let mut uno = new_uno(compile_mcusr_program());
    uno.set_boot_loader(true);
    uno.set_boot_loader(false);
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), [1]);
    assert_eq!(reset_causes(&uno), [PowerOn]);
}

#[test]
fn a_board_starts_in_its_boot_loader_after_every_reset() {
    let loader = assemble_at(0x7e00, "ldi r16, 7\n out GPIOR0, r16\n loop: rjmp loop");
    let mut uno = Uno::with_boot_loader(loader, Fidelity::DataSheet);
    uno.run_ms(1);
    reset_and_run(&mut uno);
    assert_eq!(mark_values(&uno), [7, 7]);
    assert_eq!(uno.flash()[0], 0xff);
    assert_eq!(uno.flash()[0x7e00..0x7e02], [0x07, 0xe0]);
}
