//! Tests of `Uno::say`, which sends a line to the UNO and returns its answer.

use super::*;

/// Program at 115 200 baud that first sends the line `hi`, then answers each line with the same line in capitals. It
/// halts at `!`.
const CAPITALS_PROGRAM: &str = r"
    #include <avr/io.h>
    #include <avr/sleep.h>
    static void put(char byte) { while (!(UCSR0A & 1 << UDRE0)) {} UDR0 = byte; }
    int main(void) {
        UCSR0A = 1 << U2X0; UBRR0 = 16; UCSR0B = 1 << RXEN0 | 1 << TXEN0;
        put('h'); put('i'); put('\n');
        for (;;) {
            while (!(UCSR0A & 1 << RXC0)) {}
            char byte = UDR0;
            if (byte == '!') sleep_mode();
            if (byte == '\n') put('\r');
            put(byte >= 'a' && byte <= 'z' ? byte - 32 : byte);
        }
    }";

#[test]
fn an_answer_is_the_next_line_without_its_line_end() {
    for fidelity in FIDELITIES {
        let mut uno = Uno::with_image(compile_c(CAPITALS_PROGRAM), fidelity);
        uno.run_ms(2);
        assert_eq!(uno.say("walk").as_deref(), Some("WALK"), "{fidelity:?}");
        assert_eq!(uno.say("stop 2").as_deref(), Some("STOP 2"));
        let is_removed = uno.transmitted().is_empty();
        assert!(is_removed, "the answer is removed from the record");
    }
}

#[test]
fn say_gives_up_after_a_simulated_second_of_silence() {
    // The program never reads the serial line, so it does not answer.
    let mut uno = new_uno(compile_c("int main(void) { for (;;) {} }"));
    assert_eq!(uno.say("anybody"), None);
    assert!((1000.0..1001.0).contains(&uno.ms()), "{}", uno.ms());
}

#[test]
fn firmware_that_halts_does_not_answer() {
    let mut uno = uno_after_ms(2, compile_c(CAPITALS_PROGRAM));
    assert_eq!(uno.say("!"), None);
    assert_eq!(*uno.state(), State::Halted);
}
