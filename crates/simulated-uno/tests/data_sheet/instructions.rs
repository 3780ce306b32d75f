//! Tests of the simulated pins, memory and call timing against cycles counted with the data sheet.

use super::*;

#[test]
fn the_width_of_a_pulse_is_the_sum_of_its_instruction_cycles() {
    // High at the end of the first `out`; then 3 nops and the second `out`: 4 cycles.
    let image = assemble_loop(
        "sbi DDRB, 5
         ldi r16, 0x20
         ldi r17, 0
         out PORTB, r16
         nop $ nop $ nop
         out PORTB, r17",
    );
    for uno in unos_after(100, &image) {
        // sbi 2, ldi 1, ldi 1, out 1: high after 5 cycles.
        assert_eq!(uno.pulses(LED), [Pulse { start: 5, width: 4 }]);
    }
}

#[test]
fn an_edge_is_stamped_with_the_last_cycle_of_its_instruction() {
    // First pulse: `out` (1 cycle) high, then 2 nops and `cbi` (2 cycles) low: 4 cycles. Second pulse: `sts` (2
    // cycles) high, then 1 nop and `out` (1 cycle) low: 2 cycles.
    let image = assemble_loop(
        "sbi DDRB, 5
         ldi r16, 0x20
         ldi r17, 0
         out PORTB, r16
         nop $ nop
         cbi PORTB, 5
         nop
         sts PORTB + 0x20, r16
         nop
         out PORTB, r17",
    );
    for uno in unos_after(100, &image) {
        assert_eq!(pulse_widths(&uno), [4, 2]);
    }
}

#[test]
fn edges_have_arduino_numbers_and_pins_that_are_high_together_are_counted() {
    let image = assemble_loop(
        "ldi r16, 0xff
         out DDRB, r16
         out DDRD, r16
         sbi PORTD, 3
         sbi PORTB, 1
         cbi PORTD, 3
         cbi PORTB, 1
         sbi PORTB, 3
         cbi PORTB, 3",
    );
    let uno = uno_after(100, image);
    let first_edges = [(3, true), (9, true), (3, false)];
    let last_edges = [(9, false), (11, true), (11, false)];
    assert_eq!(numbered_edges(&uno), [first_edges, last_edges].concat());
    assert_eq!(max_pins_high(&uno.edges()), 2);
}

#[test]
fn every_pin_of_every_port_is_recorded_under_its_arduino_number() {
    // The program sets and clears each bit of each port; sbi and cbi take 2 cycles each.
    let mut source =
        String::from("ldi r16, 0xff $ out DDRD, r16 $ out DDRB, r16 $ out DDRC, r16\n");
    let ports = [("PORTD", 2..8, 0), ("PORTB", 0..6, 8), ("PORTC", 0..6, 14)];
    let mut expected = Vec::new();
    for (port, bits, first_number) in ports {
        for bit in bits {
            source += &format!("sbi {port}, {bit} $ cbi {port}, {bit}\n");
            let start = 4 + 4 * expected.len() as u64 + 2;
            expected.push((Pin::arduino(first_number + bit), start, 2));
        }
    }
    let image = assemble_loop(&source);
    for uno in unos_after(200, &image) {
        for (pin, start, width) in &expected {
            let (start, width) = (*start, *width);
            assert_eq!(uno.pulses(*pin), [Pulse { start, width }], "{pin}");
        }
        assert_eq!(uno.edges().len(), 2 * 18, "D2 to D13, A0 to A5");
        assert_eq!(max_pins_high(&uno.edges()), 1);
    }
}

#[test]
fn an_analogue_pin_has_an_arduino_number_and_a_name() {
    assert_eq!(Pin::a(0), Pin::arduino(14));
    assert_eq!(Pin::a(5).number(), 19);
    assert_eq!(Pin::arduino(13), Pin::d(13));
    let names: Vec<String> = [2, 13, 14, 19].map(|n| Pin::arduino(n).to_string()).into();
    assert_eq!(names, ["D2", "D13", "A0", "A5"]);
}

#[test]
fn a_single_analogue_pin_can_be_read_and_toggled() {
    let image = assemble_loop(
        "ldi r16, 0xff $ out DDRC, r16
         sbi PORTC, 0
         sbi PINC, 5",
    );
    let mut uno = new_uno(image);
    assert!(!uno.is_high(Pin::a(0)));
    uno.run_cycles(100);
    let high_pins: Vec<u8> = (2..20).filter(|n| uno.is_high(Pin::arduino(*n))).collect();
    assert_eq!(high_pins, [14, 19]);
}

#[test]
fn sbi_on_a_pin_register_toggles_one_pin() {
    let image = assemble_loop(
        "ldi r16, 0xff $ out DDRB, r16
         sbi PORTB, 1
         sbi PINB, 5
         sbi PINB, 5",
    );
    let uno = uno_after(100, image);
    assert_eq!(numbered_edges(&uno), [(9, true), (13, true), (13, false)]);
}

#[test]
fn sleeping_with_interrupts_off_is_a_halt() {
    let image = assemble_loop("ldi r16, 1 $ out SMCR, r16 $ cli $ sleep");
    for uno in unos_after(CYCLES_PER_MS, &image) {
        assert_eq!(*uno.state(), State::Halted);
        assert!(uno.cycle() < 100, "time stops when the firmware halts");
    }
}

#[test]
fn a_store_outside_memory_is_a_crash() {
    let uno = uno_after_ms(1, assemble_loop("ldi r16, 1 $ sts 0x0fff, r16"));
    assert!(matches!(uno.state(), State::Crashed { .. }));
}

#[test]
fn resets_by_the_watchdog_are_counted() {
    let image = compile_statements(
        "MCUSR = 0;
        wdt_enable(WDTO_15MS);
        PORTB = 0; DDRB = 0x20; PORTB = 0x20;",
    );
    for uno in unos_after(70 * CYCLES_PER_MS, &image) {
        assert_eq!(uno.watchdog_reset_count(), 4, "every 16 ms");
    }
}

#[test]
fn the_depth_of_the_stack_is_measured() {
    // A call pushes its return address of two bytes; the function pushes two more.
    let image = assemble(
        "ldi r16, 0x08 $ out SPH, r16
         ldi r16, 0xff $ out SPL, r16
         rcall deep
    end: rjmp end
    deep: push r16 $ push r16 $ pop r16 $ pop r16 $ ret",
    );
    let mut uno = new_uno(image);
    assert_eq!(uno.stack_used(), 0);
    uno.run_cycles(100);
    assert_eq!(uno.stack_used(), 4);
    assert_eq!(uno.stack_spare(), 2048 - 4);
}

#[test]
fn sizes_of_memory_and_symbols_are_read_from_the_elf() {
    let image = compile_c(
        "static volatile unsigned char zeroed[100];
        static volatile unsigned char given[20] = {1};
        int main(void) { return zeroed[3] + given[4]; }",
    );
    assert_eq!(image.static_ram(), 120);
    let flash_bytes = image.flash_used();
    assert!((200..500).contains(&flash_bytes), "{flash_bytes}");
    assert_eq!(image.symbol("given").map(|symbol| symbol.size), Some(20));
}

/// Runs a program for a number of cycles, and returns the calls of its function `work`.
fn time_work(image: Image, cycles: u64) -> Vec<Call> {
    let symbol = image.symbol("work").expect("the symbol `work` is global");
    let entry = symbol.address as u32;
    new_uno(image).time_calls(entry, cycles)
}

#[test]
fn a_call_without_interrupts_takes_its_counted_cycles() {
    let image = assemble(
        "jmp start
         .org 0x68
         start: ldi r16, 0x08 $ out SPH, r16
         ldi r16, 0xff $ out SPL, r16
         call work
         end: rjmp end
         .global work
         .type work, @function
         work: ldi r20, 200
         loop: nop $ dec r20 $ brne loop
         ret",
    );
    let calls = time_work(image, 10_000);
    assert_eq!(calls.len(), 1);
    // ldi 1; 200 * (nop 1, dec 1, brne 2), the last brne 1; ret 4
    assert_eq!(calls[0].cycles(), 1 + 200 * 4 - 1 + 4);
    assert_eq!(calls[0].own_cycles(), calls[0].cycles());
}

#[test]
fn only_the_outermost_of_recursive_calls_is_timed() {
    let image = compile_with_headers(
        "__attribute__((noinline)) void work(unsigned char depth) {
            GPIOR0 = depth;
            if (depth) work(depth - 1);
            __builtin_avr_delay_cycles(1000);
        }
        int main(void) { work(9); for (;;) {} }",
    );
    let symbol = image.function("work");
    let entry = symbol.expect("the symbol `work` is a function").address as u32;
    let mut uno = new_uno(image);
    // Timing starts inside the first call, so the outermost timed call is the one with depth 8. All nested calls
    // have the same return address.
    assert!(uno.run_until(1000, 1, |uno| !uno.marks().is_empty()));
    let calls = uno.time_calls(entry, 20_000);
    assert_eq!(calls.len(), 1);
    assert!((9_000..9_300).contains(&calls[0].cycles()), "{calls:?}");
}

#[test]
fn the_cycles_of_interrupts_in_a_timed_call_are_counted_separately() {
    let image = compile_with_headers(
        "ISR(TIMER1_COMPA_vect, ISR_NAKED) { asm volatile (\"nop\\n nop\\n reti\"); }
        __attribute__((noinline)) void work(void) { __builtin_avr_delay_cycles(100000); }
        int main(void) {
            OCR1A = 999; TIMSK1 = 2; TCCR1B = 9;
            work();
            sei();
            work();
            for (;;) {}
        }",
    );
    let calls = time_work(image, 20 * CYCLES_PER_MS);
    assert_eq!(calls.len(), 2);
    assert_eq!(calls[0].interrupt_cycles, 0);
    // Each interrupt takes entry 4, jmp 3, nop 1, nop 1, reti 4: 13 cycles.
    assert!(calls[1].interrupt_cycles >= 100 * 13 && calls[1].interrupt_cycles.is_multiple_of(13));
    assert_eq!(calls[1].own_cycles(), calls[0].cycles());
}

#[test]
fn a_file_that_is_not_an_avr_elf_is_rejected() {
    let own_program = std::env::current_exe().expect("the test program has a path");
    assert!(Image::read(own_program).is_err());
    let error = Image::read("no/such.elf").expect_err("the file does not exist");
    assert!(error.to_string().starts_with("cannot read no/such.elf"));
    let endless_error = Image::read("/dev/zero").expect_err("the file never ends");
    let expected = "not an AVR ELF file: it is longer than 4 MiB";
    assert_eq!(endless_error.to_string(), expected);
}
