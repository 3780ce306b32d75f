//! Tests of the simulated serial line against the data sheet: baud rate, lost bytes, framing errors and floods.

use super::*;

/// Cycles of a 10-bit frame at exactly 115 200 baud, the sender's baud rate.
const FRAME_CYCLES: f64 = 10.0 * 16_000_000.0 / 115_200.0;
/// Cycles of a 10-bit frame that the UNO sends with UBRR = 16 and U2X: 136 cycles for each bit.
const UNO_FRAME_CYCLES: u64 = 10 * 17 * 8;

/// Compiles a program at 115 200 baud that runs `body` in an endless loop; `get()` receives a byte, `put()` sends
/// one.
fn compile(body: &str) -> Image {
    compile_with_headers(&format!(
        "static unsigned char get(void) {{ while (!(UCSR0A & 0x80)) {{}} return UDR0; }}
        static void put(unsigned char byte) {{ while (!(UCSR0A & 0x20)) {{}} UDR0 = byte; }}
        int main(void) {{
            UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x18;
            (void)get; (void)put;
            for (;;) {{ {body} }}
        }}"
    ))
}

#[test]
fn an_echo_returns_the_sent_bytes() {
    for mut uno in unos_after(CYCLES_PER_MS, &compile("put(get());")) {
        uno.send(b"the quick brown fox");
        uno.run_ms(5);
        assert_eq!(transmitted_bytes(&uno), b"the quick brown fox");
        assert_eq!(uno.unsent_byte_count(), 0);
    }
}

#[test]
fn an_echo_arrives_a_frame_after_its_byte() {
    let mut uno = uno_after_ms(1, compile("put(get());"));
    let start = uno.cycle();
    uno.send(b"x");
    uno.run_ms(1);
    let echo_cycles = uno.transmitted()[0].cycle - start;
    // The byte is received in the middle of its stop bit; the polling loop takes up to about 20 cycles.
    let earliest_cycles = (0.95 * FRAME_CYCLES) as u64 + UNO_FRAME_CYCLES;
    assert_within(earliest_cycles..earliest_cycles + 30, echo_cycles);
}

#[test]
fn bytes_are_sent_back_to_back_in_frames_of_ten_bits() {
    let uno = uno_after_ms(10, compile("put('a');"));
    let frame_ends = transmission_cycles(&uno);
    assert!(frame_ends.len() > 100);
    // A frame may end in the middle of an instruction; this does not delay the following frames.
    let mut intervals = intervals(&frame_ends).into_iter();
    assert!(intervals.all(|interval| interval == UNO_FRAME_CYCLES));
}

#[test]
fn a_flood_has_the_baud_rate_over_a_second() {
    let mut uno = new_uno(compile("get();"));
    uno.flood(b"0123456789");
    uno.run_ms(1000);
    let sent_count = uno.sent_byte_count();
    assert!(sent_count.abs_diff(11_520) <= 1, "{sent_count}");
    uno.flood(b"");
    uno.run_ms(10);
    let has_ended = uno.sent_byte_count() <= sent_count + 1;
    assert!(has_ended, "the flood has ended");
}

#[test]
fn two_bytes_wait_in_the_buffer_and_a_third_in_the_shift_register() {
    // The program reads nothing for 2 ms, in which 20 bytes can arrive.
    let late_body = "_delay_ms(2); for (unsigned char i = 0; i < 5; i++) put(get());";
    for (sent_text, kept_bytes, lost_count) in [
        ("abc", &b"abc"[..], 0),
        ("abcd", b"abd", 1),   // c is overwritten by d
        ("abcdef", b"abf", 3), // then d is overwritten by e, and e by f
    ] {
        let mut uno = uno_after(3200, compile(late_body));
        uno.send(sent_text.as_bytes());
        uno.run_ms(4);
        assert_eq!(transmitted_bytes(&uno), kept_bytes, "{sent_text}");
        assert_eq!(uno.overrun_count(), lost_count, "{sent_text}");
    }
    let mut uno = Uno::with_image(compile(late_body), Fidelity::Stock);
    uno.run_cycles(3200);
    uno.send(b"abcde");
    uno.run_ms(5);
    let stock_result = (transmitted_bytes(&uno).len(), uno.overrun_count());
    assert_eq!(stock_result, (5, 0), "stock simavr loses nothing");
}

#[test]
fn an_overrun_flag_is_cleared_by_the_next_read() {
    let body = "_delay_ms(2); unsigned char before = UCSR0A, byte = UDR0, after = UCSR0A;
                (void)byte; GPIOR0 = before; GPIOR0 = after;";
    let mut uno = uno_after(3200, compile(body));
    uno.send(b"abcd");
    uno.run_ms(3);
    let marks = uno.marks();
    assert_eq!((marks[0].value & 0x88, marks[1].value & 0x88), (0x88, 0x80));
}

#[test]
fn a_fast_receive_interrupt_loses_no_byte() {
    let image = compile_receiver("static volatile unsigned char sum; sum += UDR0; GPIOR0 = sum;");
    for mut uno in unos_after(1000, &image) {
        let bytes: Vec<u8> = (0..1000).map(|n| (n * 7) as u8).collect();
        uno.send(&bytes);
        uno.run_ms(100);
        let mut sum = 0u8;
        let sums = bytes.iter().map(|byte| {
            sum = sum.wrapping_add(*byte);
            sum
        });
        assert!(sums.eq(uno.marks().iter().map(|mark| mark.value)));
        assert_eq!(uno.overrun_count(), 0);
    }
}

#[test]
fn the_data_register_interrupt_sends_without_gaps() {
    let image = compile_with_headers(
        "ISR(USART_UDRE_vect) { static unsigned char n; UDR0 = n++; if (n == 100) UCSR0B &= ~0x20; }
        int main(void) { UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x28; sei(); for (;;) {} }",
    );
    let uno = uno_after_ms(20, image);
    assert_eq!(transmitted_bytes(&uno), (0..100).collect::<Vec<u8>>());
    let frame_intervals = intervals(&transmission_cycles(&uno));
    assert_eq!(frame_intervals, [UNO_FRAME_CYCLES; 99]);
}

#[test]
fn a_byte_written_while_the_transmitter_is_full_is_ignored() {
    // One byte is in the shift register and one in the buffer; a third does not fit.
    let body = "UDR0 = 'a'; UDR0 = 'b'; UDR0 = 'c'; _delay_ms(1); put('d'); for (;;) {}";
    let uno = uno_after_ms(3, compile(body));
    assert_eq!(transmitted_bytes(&uno), b"abd");
}

/// Sends a byte at this baud rate to a program that runs `body` in a loop, and returns the first byte that the
/// program writes to GPIOR0.
fn send_for_first_mark(baud: f64, byte: u8, body: &str) -> u8 {
    let mut uno = new_uno(compile(body));
    uno.set_baud(baud);
    uno.run_ms(1);
    uno.send(&[byte]);
    uno.run_ms(2);
    mark_values(&uno)[0]
}

#[test]
fn a_wrong_baud_rate_causes_a_framing_error() {
    let body = "while (!(UCSR0A & 0x80)) {} GPIOR0 = UCSR0A & 0x10; (void)UDR0;";
    let fast_mark = send_for_first_mark(115_200.0, b'x', body);
    assert_eq!(fast_mark, 0, "UBRR 16 is 2.1 % fast, within the tolerance");
    assert_eq!(send_for_first_mark(57_600.0, b'x', body), 0x10);
}

#[test]
fn a_wrong_baud_rate_changes_the_bytes_that_are_read() {
    let byte_read_at = |baud| send_for_first_mark(baud, b'0', "GPIOR0 = get();");
    assert_eq!(byte_read_at(115_200.0), b'0');
    // '0' is 0b0011_0000. The UNO takes its eight samples while a sender with half its baud rate sends its start bit
    // and four data bits, all 0: the samples are at 0.73, 1.22, ... 4.16 bits of the sender.
    assert_eq!(byte_read_at(57_600.0), 0);
    // With a sender at twice the baud rate, the samples are at 2.9 (0), 4.9 (0), 6.9 (1), 8.8 (0) bits of the
    // sender, and then on the idle line (1).
    assert_eq!(byte_read_at(230_400.0), 0b1111_0100);
}

#[test]
fn a_new_baud_rate_does_not_change_the_byte_that_is_on_the_line() {
    let mut uno = uno_after_ms(1, compile("GPIOR0 = get();"));
    uno.send(b"0");
    uno.run_cycles(700);
    uno.set_baud(57_600.0);
    uno.run_ms(1);
    assert_eq!(mark_values(&uno), b"0");
}

#[test]
fn a_low_stop_bit_is_a_framing_error_of_its_byte_only() {
    // FE0 is valid until UDR0 is read, so the program reads UCSR0A first (data sheet 20.7.4).
    let body = "unsigned char status; while (!((status = UCSR0A) & 0x80)) {}
                GPIOR0 = status & 0x10; GPIOR0 = UDR0;";
    for fidelity in FIDELITIES {
        let mut uno = Uno::with_image(compile(body), fidelity);
        uno.run_ms(1);
        uno.send(b"a");
        uno.send_with_framing_error(b"bc");
        uno.send(b"d");
        uno.run_ms(2);
        let expected = [0, b'a', 0x10, b'b', 0x10, b'c', 0, b'd'];
        assert_eq!(mark_values(&uno), expected, "{fidelity:?}");
        assert_eq!(
            uno.received_by_uno().len(),
            4,
            "the record includes the bytes with a framing error"
        );
    }
}

#[test]
fn a_framing_error_is_flagged_only_while_its_byte_is_the_next_byte() {
    // The program reads nothing for 2 ms; then it marks the status before it reads each byte, and after the last
    // byte.
    let body = "_delay_ms(2);
                for (unsigned char i = 0; i < 3; i++) { GPIOR0 = UCSR0A & 0x90; (void)UDR0; }
                GPIOR0 = UCSR0A & 0x90;";
    let receive_statuses = |faulty_index: usize| {
        let mut uno = uno_after(3200, compile(body));
        for (index, byte) in b"abc".iter().enumerate() {
            match index == faulty_index {
                true => uno.send_with_framing_error(&[*byte]),
                false => uno.send(&[*byte]),
            }
        }
        uno.run_ms(3);
        mark_values(&uno)
    };
    // Two bytes wait in the buffer, the third in the shift register.
    assert_eq!(receive_statuses(0), [0x90, 0x80, 0x80, 0]);
    assert_eq!(receive_statuses(1), [0x80, 0x90, 0x80, 0]);
    assert_eq!(receive_statuses(2), [0x80, 0x80, 0x90, 0]);
    let expected = [0x80, 0x80, 0x80, 0];
    assert_eq!(receive_statuses(3), expected, "no byte has a framing error");
}

#[test]
fn run_until_line_ends_after_the_line_or_at_the_limit() {
    let mut uno = new_uno(compile("put('o'); put('k'); put('\\n'); _delay_ms(50);"));
    assert!(uno.run_until_line(20 * CYCLES_PER_MS));
    assert_eq!(transmitted_bytes(&uno), b"ok\n");
    assert!(uno.cycle() < 4 * UNO_FRAME_CYCLES);
    assert!(!uno.run_until_line(20 * CYCLES_PER_MS), "50 ms of silence");
    assert!(uno.run_until_line(40 * CYCLES_PER_MS));
}

#[test]
fn the_division_of_a_run_does_not_change_when_bytes_reach_a_sleeping_board() {
    let image = compile_with_headers(
        "ISR(USART_RX_vect) { GPIOR0 = UDR0; }
        int main(void) {
            UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x90; SMCR = 1; sei();
            for (;;) asm volatile (\"sleep\");
        }",
    );
    let run_divided = |run_count: u64| {
        let mut uno = new_uno(image.clone());
        uno.run_until_cycle(12_345);
        uno.send(b"hello");
        for n in 1..=run_count {
            uno.run_until_cycle(12_345 + 100_000 * n / run_count);
        }
        uno.marks()
    };
    let undivided_marks = run_divided(1);
    assert_eq!(undivided_marks.len(), 5);
    let arrival_cycle = 12_345 + (0.95 * FRAME_CYCLES).ceil() as u64;
    // From arrival to mark: entry from sleep 8, jmp 3, a few pushes and the read of UDR0.
    assert_within(arrival_cycle..arrival_cycle + 40, undivided_marks[0].cycle);
    assert_eq!(run_divided(1000), undivided_marks);
}
