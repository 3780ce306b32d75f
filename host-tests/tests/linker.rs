//! Tests that a program computes the same results after `lizard-linker` has reordered its functions.

use lizard_host_tests::avr_gcc::{compile_to_object, link, ram_address, run_to_end, shrink};
use lizard_linker::{ROUTINES, Savings};
use simulated_uno::Image;

/// Links a program twice: unchanged, and shrunk by `lizard-linker`. Returns both images with their savings.
fn link_plain_and_shrunk(program: &str) -> [(Image, Savings); 2] {
    let object = compile_to_object(program).expect("the program compiles");
    let (shrunk, savings) = shrink(&object);
    [(object, Savings::default()), (shrunk, savings)]
        .map(|(object, savings)| (link(ROUTINES, &object).expect("the object links"), savings))
}

/// Generates a C program that a timer interrupts, with twenty functions of 600 bytes. Each function `i` of the first
/// ten calls function `i + 10`. `extra_code` is inserted before `main`.
fn generate_far_calls_program(extra_code: &str) -> String {
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
        {extra_code}
        int main(void) {{
            OCR0A = 130; TCCR0A = 2; TCCR0B = 1; TIMSK0 = 2; sei();
            uint16_t sum = 7;
            {calls}
            cli(); result = sum; done = ticks > 20;
            for (;;) {{}}
        }}"
    )
}

/// Computes the correct result of [`generate_far_calls_program`]'s program.
fn compute_expected_sum() -> u16 {
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

fn run_and_read_result(image: &Image) -> u16 {
    let uno = run_to_end(image, 100);
    let result_address = ram_address(image, "result");
    u16::from_le_bytes([uno.peek(result_address), uno.peek(result_address + 1)])
}

#[test]
fn reordered_functions_compute_the_same_result_in_fewer_bytes() {
    let [(plain_image, _), (shrunk_image, savings)] =
        link_plain_and_shrunk(&generate_far_calls_program(""));
    assert_eq!(run_and_read_result(&plain_image), compute_expected_sum());
    assert_eq!(run_and_read_result(&shrunk_image), compute_expected_sum());
    // `main` cannot be near all ten functions that it calls, but each of the ten functions can be near its callee.
    assert!(savings.call_bytes >= 20, "{savings:?}");
    let end_address = |image: &Image| image.symbol("_etext").expect("the symbol exists").address;
    let saved_bytes = end_address(&plain_image) as i64 - end_address(&shrunk_image) as i64;
    assert!(
        saved_bytes >= savings.call_bytes,
        "{saved_bytes} {savings:?}"
    );
}

#[test]
fn functions_stay_in_place_if_one_falls_through_into_the_next() {
    // The function `upper` ends without a return, with a return that may be skipped, or with a jump to `lower`.
    for ending in ["subi r24, 5", "sbrs r24, 0\\n ret", "rjmp lower"] {
        let extra_code = format!(
            r#"asm(
            ".section .text.upper, \"ax\", @progbits\n .global upper\n .type upper, @function\n"
            "upper: {ending}\n .size upper, . - upper\n"
            ".section .text.lower, \"ax\", @progbits\n .type lower, @function\n"
            "lower: com r24\n ret\n .size lower, . - lower\n .text\n");
            uint8_t upper(uint8_t a);"#
        );
        let program = generate_far_calls_program(&extra_code)
            .replace("sum = f9(sum);", "sum = f9(sum) + upper(sum);");
        let mut results = Vec::new();
        for (image, savings) in link_plain_and_shrunk(&program) {
            assert_eq!(savings.call_bytes, 0, "{ending}: {savings:?}");
            let find_symbol = |name| image.symbol(name).expect("the symbol exists");
            let upper = find_symbol("upper");
            assert_eq!(
                find_symbol("lower").address,
                upper.address + upper.size,
                "{ending}"
            );
            results.push(run_and_read_result(&image));
        }
        assert_eq!(results[0], results[1], "{ending}");
        assert_ne!(results[0], compute_expected_sum(), "{ending}");
    }
}
