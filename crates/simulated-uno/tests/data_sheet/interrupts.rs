//! Tests of the simulated interrupts and Timer1 against cycles counted with the data sheet.

use super::*;

/// Program that sleeps, with Timer1 in CTC mode and a compare interrupt every 10 000 cycles. The handler's first
/// instruction switches the LED on, and its second switches the LED off.
const TICK_PROGRAM: &str = "
    .org 0
        jmp start
    .org 0x2c                   ; TIMER1_COMPA
        jmp tick
    .org 0x68
    start:
        ldi r16, 0x08 $ out SPH, r16
        ldi r16, 0xff $ out SPL, r16
        sbi DDRB, 5
        ldi r17, 0x20
        ldi r18, 0
        ldi r16, hi8(9999) $ sts OCR1AH, r16
        ldi r16, lo8(9999) $ sts OCR1AL, r16
        ldi r16, 2 $ sts TIMSK1, r16
        ldi r16, 1 $ out SMCR, r16
        ldi r16, 0x09 $ sts TCCR1B, r16
        sei
    again:
        sleep
        rjmp again
    tick:
        out PORTB, r17
        out PORTB, r18
        reti
";

#[test]
fn the_entry_of_a_compare_interrupt_from_sleep_takes_the_cycles_in_the_data_sheet() {
    // On the chip, the counter starts with the last cycle of the `sts` to TCCR1B; in simavr it starts with the first
    // cycle. The counter matches 10 000 cycles later. Then follow interrupt entry from sleep 4 + 4, jmp of the vector
    // 3, out 1.
    let mut uno = uno_after(100_000, assemble(TICK_PROGRAM));
    let starts: Vec<u64> = uno.pulses(LED).iter().map(|pulse| pulse.start).collect();
    assert!(starts.len() >= 9);
    // jmp 3, then 2 * (ldi, out) 4, sbi 2, ldi 2, 2 * (ldi, sts) 6, (ldi, sts) 3,
    // (ldi, out) 2, ldi 1: the sts to TCCR1B begins at cycle 23.
    let numbers = 1..=starts.len() as u64;
    let expected: Vec<u64> = numbers.map(|n| 23 + n * 10_000 + 12).collect();
    assert_eq!(starts, expected);

    // The CPU is awake for 20 cycles per interrupt: entry 8, jmp 3, out 1, out 1, reti 4, rjmp 2, sleep 1.
    let awake_cycles_before = uno.awake_cycles();
    uno.run_cycles(1_000_000);
    assert_eq!(uno.awake_cycles() - awake_cycles_before, 20 * 100);
}

#[test]
fn stock_simavr_enters_an_interrupt_in_zero_cycles() {
    let mut uno = Uno::with_image(assemble(TICK_PROGRAM), Fidelity::Stock);
    uno.run_cycles(100_000);
    let first_cycle = uno.pulses(LED)[0].start;
    // In stock simavr, entry takes no time and waking from sleep takes 1 cycle; then jmp 3, out 1.
    assert_eq!(first_cycle, 23 + 10_000 + 1 + 4);
}

#[test]
fn interrupts_are_counted_with_their_cycles() {
    let uno = uno_after(100_000, assemble(TICK_PROGRAM));
    let statistics = uno.interrupt_stats();
    assert_eq!(statistics.len(), 1);
    let name = simulated_uno::vector_name(statistics[0].vector);
    assert_eq!(name, "TIMER1_COMPA");
    assert_eq!(statistics[0].entry_count, 9);
    // Each interrupt takes entry 8, jmp 3, out 1, out 1, reti 4.
    assert_eq!(statistics[0].cycles, 9 * 17);
}

#[test]
fn one_instruction_runs_between_sei_and_a_pending_interrupt() {
    let source_with_nops = |nop_count: usize| {
        format!(
            "jmp start
             .org 0x2c
             jmp tick
             .org 0x68
             start: ldi r16, 0x08 $ out SPH, r16
             ldi r16, 0xff $ out SPL, r16
             sbi DDRB, 5
             ldi r16, 2 $ sts TIMSK1, r16
             ldi r16, 1 $ sts TCCR1B, r16
             wait: sbis TIFR1, 1 $ rjmp wait
             sei
             {}
             sbi PORTB, 5
             end: rjmp end
             tick: cbi DDRB, 5
             reti",
            "nop\n".repeat(nop_count)
        )
    };
    // The handler makes the pin an input. Only one instruction after `sei` runs before the handler, so the LED is
    // switched on only if that instruction is `sbi PORTB, 5`.
    for (nops, has_edge) in [(0, true), (1, false)] {
        let mut uno = new_uno(assemble(&source_with_nops(nops)));
        uno.run_until(200_000, 1, |uno| !uno.interrupt_stats().is_empty());
        assert_eq!(!uno.edges().is_empty(), has_edge, "{nops} nops");
    }
}

#[test]
fn interrupts_enabled_after_their_flag_fire_and_flags_are_cleared_separately() {
    for (message, program, expected, stock_expected) in [
        (
            "an interrupt that is enabled fires if its flag is set",
            "ISR(TIMER1_OVF_vect) { GPIOR0 = 1; }
            int main(void) {
                TCCR1B = 1;
                while (!(TIFR1 & 1)) {}
                sei();
                TIMSK1 = 1;
                for (;;) {}
            }",
            &[1][..],
            &[][..],
        ),
        (
            "clearing a timer flag does not change the other flags",
            "int main(void) {
                OCR1A = 100; OCR1B = 200;
                TCCR1B = 1;
                while (!(TIFR1 & 4)) {}
                TIFR1 = 2;
                GPIOR0 = TIFR1;
                for (;;) {}
            }",
            &[4],
            &[0],
        ),
    ] {
        let image = compile_with_headers(program);
        let [stock_marks, data_sheet_marks] =
            unos_after(100_000, &image).map(|uno| mark_values(&uno));
        assert_eq!(data_sheet_marks, expected, "{message}");
        assert_eq!(stock_marks, stock_expected, "{CORRECTION_IS_OBSOLETE}");
    }
}

#[test]
fn an_interrupt_enabled_while_its_flag_is_set_is_served_at_once() {
    // From the first `out` to the handler's: sts 2, entry 4, jmp 3, out 1.
    let image = assemble(
        "jmp start
         .org 0x34                  ; TIMER1_OVF
         jmp over
         .org 0x68
    start:
         ldi r16, 0x08 $ out SPH, r16 $ ldi r16, 0xff $ out SPL, r16
         ldi r16, 1 $ sts TCCR1B, r16
    wait: sbis TIFR1, 0 $ rjmp wait
         sei
         out GPIOR0, r16
         sts TIMSK1, r16
    end: rjmp end
    over: out GPIOR0, r16
         reti",
    );
    let uno = uno_after(70_000, image);
    let cycles = mark_cycles(&uno);
    assert_eq!(cycles[1] - cycles[0], 2 + 4 + 3 + 1);
}

#[test]
fn high_bytes_of_16_bit_registers_are_written_through_the_shared_temp_byte() {
    // The program writes the high byte of OCR1A, then both bytes of OCR1B, then the low byte of OCR1A. A write to a
    // high byte only changes TEMP, so both registers take the high byte that was written to OCR1B.
    let image = compile_statements(
        "OCR1AH = 0x12;
        OCR1BH = 0x34; OCR1BL = 0x56;
        OCR1AL = 0x78;
        GPIOR0 = OCR1AH; GPIOR0 = OCR1AL; GPIOR0 = OCR1BH; GPIOR0 = OCR1BL;",
    );
    let uno = uno_after(500, image);
    assert_eq!(mark_values(&uno), [0x34, 0x78, 0x34, 0x56]);
}

#[test]
fn several_short_runs_give_the_same_edges_as_one_long_run() {
    for fidelity in FIDELITIES {
        let mut unbroken_uno = Uno::with_image(assemble(TICK_PROGRAM), fidelity);
        unbroken_uno.run_until_cycle(400_000);
        let mut stepped_uno = Uno::with_image(assemble(TICK_PROGRAM), fidelity);
        let mut step_cycles = 1;
        while stepped_uno.cycle() < 400_000 {
            stepped_uno.run_until_cycle((stepped_uno.cycle() + step_cycles).min(400_000));
            step_cycles = step_cycles % 997 + 13;
        }
        assert_eq!(stepped_uno.edges(), unbroken_uno.edges());
        assert_eq!(stepped_uno.sleep_cycles(), unbroken_uno.sleep_cycles());
    }
}

#[test]
fn boards_on_several_threads_do_not_affect_each_other() {
    let run = |fidelity| {
        let mut uno = Uno::with_image(assemble(TICK_PROGRAM), fidelity);
        uno.run_cycles(3_000_000);
        (uno.edges(), uno.sleep_cycles())
    };
    let expected = FIDELITIES.map(run);
    let threads: Vec<_> = (0..6)
        .map(|n| std::thread::spawn(move || (n % 2, run(FIDELITIES[n % 2]))))
        .collect();
    for thread in threads {
        let (index, result) = thread.join().expect("the thread does not panic");
        assert_eq!(result, expected[index]);
    }
}
