//! Tests of the simulated EEPROM against the data sheet, sections 8.4 to 8.6.

use super::*;

/// Cycles of an operation that erases and writes, according to table 8-1: "Erase and Write in one operation (Atomic
/// Operation)", 3.4 ms.
pub const ATOMIC_CYCLES: u64 = 3400 * CYCLES_PER_US;
/// Cycles of an operation that only erases or only writes, according to table 8-1: "Erase Only" and "Write Only",
/// 1.8 ms.
const ERASE_OR_WRITE_CYCLES: u64 = 1800 * CYCLES_PER_US;

/// Returns a UNO that has run for a number of cycles: first these instructions, then an endless loop.
fn run_assembly(source: &str, cycles: u64) -> Uno {
    uno_after(cycles, assemble_loop(source))
}

/// Compiles `body` with functions for the EEPROM: `set(address, byte, mode)` and `get(address)`, as in the examples of
/// the data sheet, and `busy()`, which is not 0 during an operation.
pub fn compile(body: &str) -> Image {
    compile_with_headers(&format!(
        "#define busy() (EECR & 2)
        static __attribute__((unused)) void set(unsigned address, unsigned char byte, unsigned char mode) {{
            while (busy()) {{}}
            EECR = mode << 4; EEAR = address; EEDR = byte;
            cli(); EECR |= 4; EECR |= 2;
        }}
        static __attribute__((unused)) unsigned char get(unsigned address) {{
            while (busy()) {{}}
            EEAR = address; EECR |= 1; return EEDR;
        }}
        {body}"
    ))
}

/// Returns a UNO that has run for a number of milliseconds and whose main program runs these statements once.
fn run_c(body: &str, ms: u64) -> Uno {
    let image = compile(&format!("int main(void) {{ {body} for (;;) {{}} }}"));
    uno_after_ms(ms, image)
}

#[test]
fn a_new_eeprom_is_erased_and_its_1024_bytes_can_be_set() {
    let mut uno = run_c("GPIOR0 = get(0); GPIOR0 = get(1023); GPIOR0 = get(512);", 1);
    assert_eq!(mark_values(&uno), [0xff, 0xff, 0xff]);
    let mut contents = [0; EEPROM_SIZE];
    (contents[0], contents[1023], contents[512]) = (1, 2, 3);
    uno.set_eeprom(&contents);
    uno.take_marks();
    uno.reset();
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), [1, 2, 3]);
    assert_eq!(uno.eeprom(), contents);
}

#[test]
fn register_values_match_the_data_sheet() {
    for (message, body, expected) in [
        (
            // "EEAR9:0": the other bits always read as zero (8.6.1).
            "an address has ten bits",
            "EEAR = 0xffff; GPIOR0 = EEARH; GPIOR0 = EEARL;",
            &[0x03, 0xff][..],
        ),
        (
            // "If a write operation is in progress, it is neither possible to read the
            // EEPROM, nor to change the EEAR Register"; "While EEPE is set, any write to
            // EEPMn will be ignored" (8.6.3).
            "during a write, its address, mode and data cannot be changed",
            "set(0x123, 0x42, 0);
            EEAR = 0x2aa; EEDR = 0x99; EECR = 0x20;
            GPIOR0 = EEARH; GPIOR0 = EEARL; GPIOR0 = EECR;
            while (busy()) {}
            EEAR = 0x2aa; GPIOR0 = EEARL;
            GPIOR0 = get(0x123); GPIOR0 = get(0x2aa);",
            &[0x01, 0x23, 0x02, 0xaa, 0x42, 0xff],
        ),
        (
            "during a write, a read and a second write are ignored",
            "set(5, 0x42, 0);
            EEDR = 0x77;
            EECR |= 1; GPIOR0 = EEDR;
            EECR = 4; EECR |= 2;
            while (busy()) {}
            GPIOR0 = get(5);",
            &[0x77, 0x42],
        ),
    ] {
        let uno = run_c(body, 10);
        assert_eq!(mark_values(&uno), expected, "{message}");
        assert!(uno.eeprom_operations().len() <= 1, "{message}");
    }
}

/// Returns a UNO that has set EEMPE and, `nop_count + 2` cycles later, EEPE: the program runs `nop_count` nops between
/// the two instructions `sbi`.
fn set_eempe_then_eepe(nop_count: usize) -> Uno {
    let nops = "nop\n".repeat(nop_count);
    let source = format!(
        "ldi r16, 0x5a $ out EEDR, r16
         sbi EECR, EEMPE
         {nops}
         sbi EECR, EEPE"
    );
    run_assembly(&source, ATOMIC_CYCLES + 100)
}

#[test]
fn eepe_must_be_set_within_four_cycles_after_eempe() {
    // "When EEMPE is set, setting EEPE within four clock cycles will write data to
    // the EEPROM at the selected address. If EEMPE is zero, setting EEPE will have
    // no effect" (8.6.3).
    for (nop_count, is_written) in [(0, true), (1, true), (2, true), (3, false), (9, false)] {
        let uno = set_eempe_then_eepe(nop_count);
        let expected = if is_written { 0x5a } else { 0xff };
        assert_eq!(uno.eeprom()[0], expected, "{nop_count} nops");
        assert_eq!(uno.eeprom_operations().len(), usize::from(is_written));
    }
}

#[test]
fn hardware_clears_eempe_after_four_cycles() {
    // "When EEMPE has been written to one by software, hardware clears the bit to zero after four clock cycles"
    // (8.6.3). The bit is set at the end of the `sbi`; the n-th `in` after the `sbi` reads in the n-th cycle.
    let uno = run_assembly(
        "sbi EECR, EEMPE
         in r16, EECR $ in r17, EECR $ in r18, EECR $ in r19, EECR $ in r20, EECR
         out GPIOR0, r16 $ out GPIOR0, r17 $ out GPIOR0, r18
         out GPIOR0, r19 $ out GPIOR0, r20",
        100,
    );
    assert_eq!(mark_values(&uno), [4, 4, 4, 4, 0]);
}

#[test]
fn the_eeprom_is_not_written_without_the_timed_sequence() {
    for (message, source) in [
        ("EEPE alone has no effect", "sbi EECR, EEPE"),
        (
            // "Write a logical one to the EEMPE bit while writing a zero to EEPE" (8.6.3).
            "setting both bits at once has no effect",
            "ldi r16, 6 $ out EECR, r16 $ out EECR, r16",
        ),
        (
            // "the CBI and SBI instructions will only operate on the specified bit" (8.5).
            "cbi on another bit of EECR does not set EEMPE again",
            "sbi EECR, EEMPE $ cbi EECR, EERIE $ nop $ sbi EECR, EEPE",
        ),
    ] {
        let uno = run_assembly(source, ATOMIC_CYCLES + 100);
        assert!(uno.eeprom_operations().is_empty(), "{message}");
    }
}

#[test]
fn eepe_is_one_for_the_duration_in_table_8_1() {
    // EEPM1:0 is 00 for erase and write (3.4 ms), 01 for erase only (1.8 ms), 10 for write only (1.8 ms).
    for (mode, duration, expected_mode) in [
        (0, ATOMIC_CYCLES, EepromMode::EraseAndWrite),
        (1, ERASE_OR_WRITE_CYCLES, EepromMode::EraseOnly),
        (2, ERASE_OR_WRITE_CYCLES, EepromMode::WriteOnly),
    ] {
        let body = format!("set(7, 0x33, {mode}); while (busy()) {{}} GPIOR0 = 1;");
        let uno = run_c(&body, 5);
        let operation = uno.eeprom_operations()[0];
        assert_eq!((operation.address, operation.mode), (7, expected_mode));
        let busy_cycles = uno.marks()[0].cycle - operation.cycle;
        assert_within(duration..duration + 10, busy_cycles);
    }
}

#[test]
fn erase_only_sets_all_bits_and_write_only_clears_bits() {
    let body = "set(0, 0x0f, 2); set(0, 0xf5, 2);
        set(1, 0x0f, 0); set(1, 0x55, 1);
        set(2, 0x0f, 0); set(2, 0xf0, 0);";
    let uno = run_c(body, 30);
    assert_eq!(uno.eeprom()[..4], [0x05, 0xff, 0xf0, 0xff]);
    let operations = uno.eeprom_operations();
    let old_values = operations.iter().map(|operation| operation.old_value);
    let new_values = operations.iter().map(|operation| operation.new_value);
    assert!(old_values.eq([0xff, 0x0f, 0xff, 0x0f, 0xff, 0x0f]));
    assert!(new_values.eq([0x0f, 0x05, 0x0f, 0xff, 0x0f, 0xf0]));
}

#[test]
fn a_byte_has_its_old_value_until_the_operation_ends() {
    let mut uno = new_uno(compile("int main(void) { set(9, 0x21, 0); for (;;) {} }"));
    uno.run_until(1000, 1, |uno| !uno.eeprom_operations().is_empty());
    let end_cycle = uno.eeprom_operations()[0].cycle + ATOMIC_CYCLES;
    uno.run_until_cycle(end_cycle - 10);
    assert_eq!(uno.eeprom()[9], 0xff);
    uno.run_until_cycle(end_cycle + 10);
    assert_eq!(uno.eeprom()[9], 0x21);
}

#[test]
fn the_cpu_halts_four_cycles_to_read_and_two_to_write() {
    // "When the EEPROM is read, the CPU is halted for four clock cycles before the
    // next instruction is executed"; "When EEPE has been set, the CPU is halted for
    // two cycles before the next instruction is executed" (8.6.3).
    let uno = run_assembly(
        "sbi DDRB, 5
         sbi PORTB, 5
         sbi EECR, EERE
         cbi PORTB, 5
         sbi EECR, EEMPE
         sbi PORTB, 5
         sbi EECR, EEPE
         cbi PORTB, 5
         sbi PORTB, 5
         sbi EECR, EEPE
         cbi PORTB, 5",
        100,
    );
    // sbi 2 + halt + cbi 2. The last `sbi` of EEPE is ignored, so the CPU does not halt.
    assert_eq!(pulse_widths(&uno), [8, 6, 4]);
}

#[test]
fn halts_by_the_eeprom_do_not_delay_a_timer() {
    // Timer1 counts while the CPU is halted, so the delays of its interrupt do not add up.
    let image = compile(
        "ISR(TIMER1_COMPA_vect) { GPIOR0 = TCNT1L; }
        int main(void) {
            OCR1A = 1999; TIMSK1 = 2; TCCR1B = 9; sei();
            for (;;) { EECR |= 1; EECR |= 1; EECR |= 1; EECR |= 1; }
        }",
    );
    let counts = mark_values(&uno_after_ms(20, image));
    assert!(counts.len() > 150);
    let (earliest, latest) = (counts.iter().min(), counts.iter().max());
    let spread = latest.expect("there are counts") - earliest.expect("there are counts");
    assert!(spread <= 6, "{counts:?}"); // the longest instruction: sbi and its halt
}

#[test]
fn the_ready_interrupt_is_requested_while_eepe_is_zero() {
    // "The EEPROM Ready interrupt generates a constant interrupt when EEPE is
    // cleared" (8.6.3). The handler writes three bytes, then disables its interrupt.
    let image = compile(
        "static unsigned char count;
        ISR(EE_READY_vect) {
            GPIOR0 = count;
            if (count == 3) { EECR &= ~8; return; }
            EEAR = count; EEDR = count + 1; count++;
            EECR |= 4; EECR |= 2;
        }
        int main(void) { SMCR = 1; EECR = 8; sei(); for (;;) asm volatile (\"sleep\"); }",
    );
    let uno = uno_after_ms(15, image);
    assert_eq!(mark_values(&uno), [0, 1, 2, 3]);
    assert_eq!(uno.eeprom()[..4], [1, 2, 3, 0xff]);
    let is_asleep = uno.sleep_cycles() as f64 / uno.cycle() as f64 > 0.6;
    assert!(is_asleep, "the CPU sleeps while a byte is programmed");
    let operations = uno.eeprom_operations();
    let starts: Vec<u64> = operations.iter().map(|operation| operation.cycle).collect();
    for interval in intervals(&starts) {
        assert_within(ATOMIC_CYCLES..ATOMIC_CYCLES + 150, interval);
    }
}

#[test]
fn the_ready_interrupt_fires_at_once_and_again_after_one_instruction() {
    let uno = run_assembly(
        "jmp start
         .org 0x58                  ; EE_READY
         sbi GPIOR0, 0
         reti
         .org 0x68
    start:
         ldi r16, 0x08 $ out SPH, r16 $ ldi r16, 0xff $ out SPL, r16
         sei
         nop
         sbi EECR, EERIE
         nop",
        400,
    );
    let cycles = mark_cycles(&uno);
    // To the first mark: jmp 3, (ldi, out, ldi, out) 4, sei 1, nop 1, sbi 2, entry 4, sbi 2.
    assert_eq!(cycles[0], 17);
    // From mark to mark: reti 4, one instruction (nop 1, then rjmp 2), entry 4, sbi 2.
    assert_eq!(cycles[1] - cycles[0], 4 + 1 + 4 + 2);
    assert_eq!(cycles[2] - cycles[1], 4 + 2 + 4 + 2);
}

#[test]
fn a_reset_does_not_end_a_write_or_change_its_mode() {
    // "If a reset occurs while a write operation is in progress, the write
    // operation will be completed provided that the power supply voltage is
    // sufficient" (8.4.2); "During reset, the EEPMn bits will be reset to 0b00
    // unless the EEPROM is busy programming" (8.6.3).
    let mut uno = run_c(
        "GPIOR0 = EECR;
        if (!busy()) set(3, 0x42, 2);
        while (busy()) {}
        GPIOR0 = 0xaa;",
        1,
    );
    uno.reset();
    uno.run_cycles(100);
    assert_eq!(mark_values(&uno), [0x00, 0x22]);
    uno.run_ms(5);
    assert_eq!(uno.eeprom()[3], 0x42);
    let duration = uno.marks()[2].cycle - uno.eeprom_operations()[0].cycle;
    assert_within(ERASE_OR_WRITE_CYCLES..ERASE_OR_WRITE_CYCLES + 20, duration);
    uno.reset();
    uno.run_cycles(100);
    let value = mark_values(&uno)[3];
    assert_eq!(value, 0, "a reset clears EEPM while the EEPROM is idle");
}

#[test]
fn a_reset_disarms_eempe() {
    // The run of five cycles ends with the `sbi` to EEMPE.
    let mut uno = run_assembly("in r16, GPIOR1 $ sbi EECR, EEPE $ sbi EECR, EEMPE", 5);
    uno.reset();
    uno.run_cycles(100);
    assert!(uno.eeprom_operations().is_empty());
}

#[test]
fn stock_simavr_writes_at_once_and_never_reads_busy() {
    let image = compile("int main(void) { set(0, 0x21, 1); GPIOR0 = EECR; for (;;) {} }");
    let mut uno = Uno::with_image(image, Fidelity::Stock);
    uno.run_cycles(200);
    assert_eq!(mark_values(&uno), [0x10], "{CORRECTION_IS_OBSOLETE}");
    assert_eq!(
        uno.eeprom()[0],
        0x21,
        "stock simavr writes even in the erase-only mode"
    );
}
