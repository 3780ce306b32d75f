//! What the linker's program does to static data and to the order of functions leaves a
//! program the same.

use lizard_host_tests::avr_gcc::c_by_way_of_an_object;
use lizard_linker::{ROUTINES, Savings, shrink};
use simulated_uno::{Fidelity, Image, Uno};

/// A program as avr-gcc links it and as it is made shorter, and how much that was.
fn both(program: &str) -> [(Image, Savings); 2] {
    let savings = std::cell::Cell::new(Savings::default());
    let plain = c_by_way_of_an_object(program, |object| (object, ROUTINES));
    let short = c_by_way_of_an_object(program, |object| {
        let (new, saved) = shrink(&object)
            .expect("it is an object")
            .expect("of an AVR");
        savings.set(saved);
        (new, ROUTINES)
    });
    [(plain, Savings::default()), (short, savings.get())]
}

fn address(image: &Image, name: &str) -> u16 {
    let symbol = image.symbol(name);
    (symbol.expect("the program has it").address - 0x80_0000) as u16
}

/// A UNO that has run the program to its end.
fn run(image: &Image) -> Uno {
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    uno.run_ms(100);
    assert_eq!(
        uno.peek(address(image, "done")),
        1,
        "it came to its end, interrupted where it is to be"
    );
    uno
}

/// Variables that are zero nearly, hardly and not at all; one that holds an address; and what
/// code before `main` saw of the first.
const DATA: &str = r#"
#include <stdint.h>
#define IN(section_) __attribute__((section(section_)))
volatile uint8_t done;
volatile uint8_t seen[4];
IN(".data.few") volatile uint8_t few[700] = {[0] = 1, [7] = 255, [8] = 3, [263] = 9, [699] = 77};
IN(".data.words") volatile uint16_t words[60] = {[3] = 0x1234, [50] = 0x00ff};
IN(".data.full") volatile uint8_t full[40] = {1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,
    21,22,23,24,25,26,27,28,29,30,31,32,33,34,35,36,37,38,39,40};
IN(".data.leads") volatile uint8_t *volatile leads[40] = {[2] = &few[263]};
__attribute__((constructor)) static void early(void) {
    seen[0] = few[0]; seen[1] = few[1]; seen[2] = few[263]; seen[3] = words[3];
}
int main(void) { done = *leads[2] == 9; for (;;) {} }
"#;

#[test]
fn a_variable_that_is_nearly_zero_has_its_values_before_any_code_asks_for_them() {
    let mut expected = vec![0; 700];
    for (place, value) in [(0, 1), (7, 255), (8, 3), (263, 9), (699, 77)] {
        expected[place] = value;
    }
    let mut words = vec![0; 120];
    for (place, value) in [(6, 0x34), (7, 0x12), (100, 0xff)] {
        words[place] = value;
    }
    for (image, savings) in both(DATA) {
        let uno = run(&image);
        let bytes = |name, count| -> Vec<u8> {
            let begin = address(&image, name);
            (begin..begin + count).map(|at| uno.peek(at)).collect()
        };
        assert_eq!(bytes("few", 700), expected, "{savings:?}");
        assert_eq!(bytes("words", 120), words, "{savings:?}");
        assert_eq!(bytes("full", 40), (1..=40).collect::<Vec<u8>>());
        assert_eq!(bytes("seen", 4), [1, 0, 9, 0x34]);
        // Cleared are the two that gain by it, and no other.
        let bss = address(&image, "__bss_start");
        let is_cleared = |name| address(&image, name) >= bss;
        let is_short = savings.data > 0;
        assert_eq!(is_cleared("few"), is_short);
        assert_eq!(is_cleared("words"), is_short);
        assert!(!is_cleared("full") && !is_cleared("leads"));
        if is_short {
            // Five values, one of them farther than a byte tells; three; a loop for each.
            assert_eq!(savings.data, (700 - 12 - 22) + (120 - 6 - 22));
        }
    }
}

/// Functions of 600 bytes, each of which calls the one that is ten farther, while a timer
/// interrupts them.
fn far_calls(more: &str) -> String {
    let functions: String = (0..20)
        .rev()
        .map(|index| {
            let callee = index + 10;
            let call = match callee {
                0..20 => format!("f{callee}(a ^ {index})"),
                _ => "1".into(),
            };
            format!(
                "__attribute__((noinline)) uint16_t f{index}(uint16_t a) {{
                    asm volatile(\".rept 300\\n nop\\n .endr\");
                    a = a * 33 + {index}; return a ^ {call}; }}\n"
            )
        })
        .collect();
    let calls: String = (0..10)
        .map(|index| format!("sum = f{index}(sum);"))
        .collect();
    format!(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        #include <stdint.h>
        volatile uint8_t done; volatile uint16_t ticks, result;
        ISR(TIMER0_COMPA_vect) {{ ticks++; }}
        {functions}
        {more}
        int main(void) {{
            OCR0A = 130; TCCR0A = 2; TCCR0B = 1; TIMSK0 = 2; sei();
            uint16_t sum = 7;
            {calls}
            cli(); result = sum; done = ticks > 20;
            for (;;) {{}}
        }}"
    )
}

/// What [`far_calls`] computes.
fn far_sum() -> u16 {
    fn f(index: u16, a: u16) -> u16 {
        let a = a.wrapping_mul(33).wrapping_add(index);
        a ^ if index < 10 {
            f(index + 10, a ^ index)
        } else {
            1
        }
    }
    (0..10).fold(7, |sum, index| f(index, sum))
}

fn result(image: &Image) -> u16 {
    let uno = run(image);
    let at = address(image, "result");
    u16::from_le_bytes([uno.peek(at), uno.peek(at + 1)])
}

#[test]
fn functions_that_lie_in_another_order_compute_the_same_in_fewer_bytes() {
    let [(plain, _), (short, savings)] = both(&far_calls(""));
    assert_eq!(result(&plain), far_sum());
    assert_eq!(result(&short), far_sum());
    // Main cannot be near all ten that it calls, but those near what they call.
    assert!(savings.calls >= 20, "{savings:?}");
    let end = |image: &Image| image.symbol("_etext").expect("it has one").address;
    let saved = end(&plain) as i64 - end(&short) as i64;
    assert!(saved >= savings.calls, "{saved} {savings:?}");
}

#[test]
fn functions_stay_where_they_are_if_one_of_them_needs_the_next_behind_it() {
    // One without an end, one whose end may be skipped, one that reaches so far and no farther.
    for end in ["subi r24, 5", "sbrs r24, 0\\n ret", "rjmp lower"] {
        let more = format!(
            r#"asm(
            ".section .text.upper, \"ax\", @progbits\n .global upper\n .type upper, @function\n"
            "upper: {end}\n .size upper, . - upper\n"
            ".section .text.lower, \"ax\", @progbits\n .type lower, @function\n"
            "lower: com r24\n ret\n .size lower, . - lower\n .text\n");
            uint8_t upper(uint8_t a);"#
        );
        let program = far_calls(&more).replace("sum = f9(sum);", "sum = f9(sum) + upper(sum);");
        let mut results = Vec::new();
        for (image, savings) in both(&program) {
            assert_eq!(savings.calls, 0, "{end}: {savings:?}");
            let symbol = |name| image.symbol(name).expect("it has one");
            let upper = symbol("upper");
            assert_eq!(symbol("lower").address, upper.address + upper.size, "{end}");
            results.push(result(&image));
        }
        assert_eq!(results[0], results[1], "{end}");
        assert_ne!(results[0], far_sum(), "{end}");
    }
}

/// Truth values that are asked for at once: two that are nothing else, and one each that is
/// asked for again (by the function, by what it calls, by its caller), whose comparison
/// leaves flags behind, into whose middle others come, of which the beginning may be skipped,
/// and whose zero is half a product.
const TRUTHS: &str = r#"
#include <avr/io.h>
#include <avr/interrupt.h>
#include <stdint.h>
volatile uint8_t done; volatile uint16_t ticks, result;
ISR(TIMER0_COMPA_vect) { ticks++; }
asm(
    ".section .text.decides, \"ax\", @progbits\n .global decides\n .type decides, @function\n decides:\n"
    "cpi r24, 100\n ldi r18, 1\n brcs 1f\n mov r18, r1\n 1: andi r18, 1\n brne 2f\n subi r25, 3\n"
    "2: ldi r18, 7\n add r25, r18\n"
    "cpi r25, 50\n ldi r19, 1\n brge 1f\n ldi r19, 0\n 1: cpi r19, 0\n breq 2f\n inc r24\n"
    "2: ldi r19, 2\n add r24, r19\n"
    "cpi r24, 30\n ldi r20, 1\n brcs 1f\n mov r20, r1\n 1: cpi r20, 0\n breq 2f\n com r25\n"
    "2: add r25, r20\n"
    "cpi r24, 200\n ldi r21, 1\n brcs 1f\n mov r21, r1\n 1: cpi r21, 0\n brne 2f\n inc r24\n"
    "2: sbc r25, r1\n"
    "ldi r22, 0\n cpi r24, 60\n brcs 1f\n cpi r25, 77\n ldi r22, 1\n brcs 1f\n mov r22, r1\n"
    "1: andi r22, 1\n brne 2f\n subi r24, 9\n 2: add r25, r24\n"
    "ldi r23, 0\n cpi r24, 90\n sbrc r25, 0\n ldi r23, 1\n brcs 1f\n mov r23, r1\n"
    "1: andi r23, 1\n brne 2f\n subi r24, 11\n 2: add r25, r24\n"
    "cpi r25, 120\n ldi r24, 1\n brcs 1f\n mov r24, r1\n 1: andi r24, 1\n brne 2f\n inc r25\n"
    "2: call asked\n"
    "cpi r25, 99\n ldi r24, 1\n brcs 1f\n mov r24, r1\n 1: andi r24, 1\n brne 2f\n subi r25, 5\n"
    "2: ret\n"
    ".size decides, . - decides\n"
    ".section .text.asked, \"ax\", @progbits\n .type asked, @function\n asked:\n"
    "add r25, r24\n ret\n .size asked, . - asked\n"
    ".section .text.products, \"ax\", @progbits\n .global products\n .type products, @function\n products:\n"
    "mul r24, r25\n cpi r24, 128\n ldi r18, 1\n brcs 1f\n mov r18, r1\n 1: andi r18, 1\n brne 2f\n subi r24, 9\n"
    "2: ldi r18, 3\n add r24, r18\n eor r1, r1\n ret\n"
    ".size products, . - products\n .text\n");
uint16_t decides(uint16_t a);
uint16_t products(uint16_t a);
int main(void) {
    OCR0A = 130; TCCR0A = 2; TCCR0B = 1; TIMSK0 = 2; sei();
    uint16_t sum = 0, a = 1;
    for (uint16_t i = 0; i < 3000; i++) {
        a ^= a << 7; a ^= a >> 9; a ^= a << 8;
        sum = sum * 31 + decides(a) + 3 * products(a);
    }
    cli(); result = sum; done = ticks > 500;
    for (;;) {}
}
"#;

#[test]
fn truth_values_that_nobody_else_asks_for_are_branches() {
    let [(plain, _), (short, savings)] = both(TRUTHS);
    assert_eq!(savings.truths, 2 * 8, "{savings:?}");
    assert_eq!(result(&plain), result(&short));
    assert_ne!(result(&plain), 0);
}
