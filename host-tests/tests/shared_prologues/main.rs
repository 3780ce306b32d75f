//! Tests that functions compute the same results with shared prologues and epilogues as with their own.

use lizard_host_tests::avr_gcc::{
    assemble, compile_to_object, link, ram_address, run_to_end, shrink,
};
use lizard_host_tests::read_file;
use lizard_linker::ROUTINES;
use lizard_linker::frame::LOWEST_REGISTERS;
use simulated_uno::{Fidelity, Image, Uno};

mod random_programs;

/// A program that sorts, divides, mixes and recurses while a timer interrupts it. The program uses many registers and
/// large stack frames, and stores its results in RAM.
const STRESS_PROGRAM: &str = r#"
#include <avr/io.h>
#include <avr/interrupt.h>
#include <stdint.h>
#define NOINLINE __attribute__((noinline))
volatile uint32_t results[40];
volatile uint8_t done;
volatile uint16_t ticks;
ISR(TIMER0_COMPA_vect) { ticks++; }

static uint32_t state = 12345;
NOINLINE uint32_t next(void) { state ^= state << 13; state ^= state >> 17; state ^= state << 5; return state; }

NOINLINE uint32_t mix(uint32_t a, uint32_t b, uint32_t c, uint16_t d) {
    uint32_t x = a + next(), y = b ^ next(), z = c - next();
    for (uint8_t i = 0; i < 5; i++) {
        x += y * d; y ^= z + next(); z = (z << 3) | (z >> 29); x -= next();
    }
    return x ^ y ^ z ^ a ^ b ^ c;
}

NOINLINE uint16_t sort(uint8_t n) {
    uint16_t values[30], sum = 0;
    for (uint8_t i = 0; i < n; i++) values[i] = next();
    for (uint8_t i = 1; i < n; i++)
        for (uint8_t k = i; k && values[k] < values[k - 1]; k--) {
            uint16_t smaller = values[k]; values[k] = values[k - 1]; values[k - 1] = smaller;
        }
    for (uint8_t i = 0; i < n; i++) { if (values[i] == 7) return i; sum = sum * 31 + values[i] + i; }
    return sum;
}

NOINLINE uint32_t recurse(uint8_t n, uint32_t seed) {
    volatile uint8_t buffer[20];
    for (uint8_t i = 0; i < sizeof buffer; i++) buffer[i] = seed >> (i & 7);
    uint32_t inner = n ? recurse(n - 1, seed * 3 + n) : 1;
    for (uint8_t i = 0; i < sizeof buffer; i++) inner = inner * 5 + buffer[i];
    if (inner & 1) return inner - seed;
    return inner / (seed | 1) + seed;
}

NOINLINE uint64_t divide(uint64_t a, uint64_t b) { uint64_t c = a * b + next(); return c / (a | 3) + mix(a, b, c, c); }

/* Three conditional branches, each over an rjmp. The second rjmp is also the target of another branch, and SBRC may
   skip the third branch. */
asm(
    ".section .text.jumps, \"ax\", @progbits\n .global jumps\n .type jumps, @function\n jumps:\n"
    "cpi r24, 100\n brcs 1f\n rjmp 2f\n 1: subi r25, 40\n"
    "2: cpi r25, 77\n brcs 3f\n cpi r24, 9\n brcc 4f\n 3: rjmp 5f\n 4: subi r24, 3\n"
    "5: cpi r24, 50\n sbrc r25, 0\n brcs 6f\n rjmp 7f\n 6: inc r25\n 7: ret\n"
    ".size jumps, . - jumps\n"
    ".text\n");
uint16_t jumps(uint16_t a);

int main(void) {
    OCR0A = 130; TCCR0A = 2; TCCR0B = 1; TIMSK0 = 2; sei();
    for (uint8_t i = 0; i < 10; i++) {
        results[4 * i] = mix(next(), next(), next(), i);
        results[4 * i + 1] = sort(20 + i) + ((uint32_t)jumps(next()) << 16);
        results[4 * i + 2] = recurse(i, next());
        results[4 * i + 3] = divide(next(), next());
    }
    cli();
    done = ticks > 500 ? 1 : 2;
    for (;;) {}
}
"#;

/// Runs the program to its end. Returns its results and its stack depth.
fn run_stress_program(image: &Image) -> (Vec<u8>, u16) {
    let results_address = ram_address(image, "results");
    let uno = run_to_end(image, 200);
    let addresses = results_address..results_address + 160;
    let bytes = addresses.map(|address| uno.peek(address)).collect();
    (bytes, uno.stack_used())
}

#[test]
fn a_program_computes_the_same_results_with_shared_prologues_and_epilogues() {
    let object = compile_to_object(STRESS_PROGRAM).expect("the program compiles");
    let (shrunk, savings) = shrink(&object);
    assert!(savings.frame_bytes > 100, "{savings:?}");
    // In `jumps`, only the first branch over a jump is replaced, which saves 2 bytes.
    assert_eq!(savings.branch_bytes, 2, "{savings:?}");
    let plain_image = link("", &object).expect("the object links");
    let shrunk_image = link(ROUTINES, &shrunk).expect("the shrunk object links");
    assert!(shrunk_image.symbol("__frame_save_2").is_some());
    let (plain_results, plain_depth) = run_stress_program(&plain_image);
    let (shrunk_results, shrunk_depth) = run_stress_program(&shrunk_image);
    assert_eq!(plain_results, shrunk_results);
    assert!(plain_results.iter().any(|byte| *byte != 0));
    // Ten stack frames of `recurse` exist at the same time, and each may save one more register.
    assert!(
        shrunk_depth.abs_diff(plain_depth) < 40,
        "stack depth {plain_depth} plain, {shrunk_depth} shrunk"
    );
}

/// A program with a function whose last argument is on the stack, above the pushed registers. The function does not
/// push every register between the first and the last, and has local variables on the stack.
const STACK_ARGUMENT_PROGRAM: &str = r#"
#include <stdint.h>
volatile uint8_t done, sum;
volatile uint16_t result;
uint8_t table[20];
__attribute__((noinline, noclone)) uint16_t return_last(uint32_t a, uint32_t b, uint32_t c, uint32_t d,
    uint16_t e, uint16_t on_the_stack) {
    uint8_t buffer[20], mixed = 0, *p = buffer, *q = table;
    for (uint8_t i = 0; i < 20; i++) buffer[i] = table[i] + (uint8_t)a;
    asm volatile("" :: "m"(buffer));
    for (uint8_t i = 0; i < 20; i++) mixed ^= *p++ + *q++;
    sum = mixed + (uint8_t)(b ^ c ^ d ^ e);
    return on_the_stack;
}
int main(void) { result = return_last(1, 2, 3, 4, 5, 0x1234); done = 1; for (;;) {} }
"#;

#[test]
fn an_argument_on_the_stack_is_read_where_the_caller_put_it() {
    let object = compile_to_object(STACK_ARGUMENT_PROGRAM).expect("the program compiles");
    let image = link(ROUTINES, &shrink(&object).0).expect("the object links");
    let result_address = ram_address(&image, "result");
    let uno = run_to_end(&image, 10);
    let result_bytes = [uno.peek(result_address), uno.peek(result_address + 1)];
    assert_eq!(result_bytes, [0x34, 0x12]);
}

#[test]
fn interprocedural_register_allocation_is_disabled() {
    let flags = read_file(".cargo/config.toml");
    let llvm_args_line = flags.lines().find(|line| line.contains("\"-Cllvm-args="));
    let llvm_args_line = llvm_args_line.expect(".cargo/config.toml lists the LLVM arguments");
    assert!(!llvm_args_line.contains("ipra"), "{llvm_args_line}");
}

/// The call-saved registers, which a function restores before it returns.
const CALL_SAVED_REGISTERS: [u8; 18] = [
    2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 28, 29,
];

/// Generates a program that calls a function forty times while a timer interrupts it every 61 cycles. The function
/// saves the registers from `first_register` on, allocates `locals_bytes` bytes for local variables, overwrites
/// registers and variables, restores the registers, and returns. At the end, the program stores the registers and the
/// stack pointer in RAM.
fn generate_frame_program(first_register: u8, locals_bytes: u8) -> String {
    let load = |registers: &[u8], increment: u8| -> String {
        registers
            .iter()
            .map(|register| format!("ldi r24, {} $ mov r{register}, r24\n", register + increment))
            .collect()
    };
    let mut saved_registers = CALL_SAVED_REGISTERS.to_vec();
    saved_registers.retain(|register| *register >= first_register);
    let store_code: String = CALL_SAVED_REGISTERS
        .iter()
        .map(|register| format!("sts {}, r{register}\n", 0x100 + u16::from(*register)))
        .collect();
    format!(
        "jmp start
        .org 0x38
        jmp tick
        .org 0x68
    start: clr r1 $ clr r20 $ clr r21
        ldi r24, 0xff $ out SPL, r24 $ ldi r24, 0x08 $ out SPH, r24
        ldi r24, 60 $ out OCR0A, r24 $ ldi r24, 2 $ out TCCR0A, r24 $ sts TIMSK0, r24
        ldi r24, 1 $ out TCCR0B, r24 $ sei
        ldi r19, 40
        {load_all}
    again: ldi r26, {locals_bytes} $ call framed
        dec r19 $ brne again
        cli
        {store_code}
        in r24, SPL $ sts 0x140, r24 $ in r24, SPH $ sts 0x141, r24
        sts 0x142, r1 $ sts 0x143, r20 $ sts 0x144, r21
        ldi r24, 1 $ sts 0x145, r24
    end: rjmp end
    framed: ldi r26, {locals_bytes} $ call __frame_save_{first_register}
        ; The locals start one byte above Y (r29:r28) and belong only to this function.
        movw r30, r28 $ ldi r24, {locals_bytes} $ ldi r25, 0x55
    fill: subi r24, 1 $ brcs filled $ adiw r30, 1 $ st Z, r25 $ rjmp fill
    filled: in r24, SPL $ cp r24, r28 $ breq same $ inc r20
    same: push r25 $ pop r25
        {overwrite_saved}
        ldi r26, {locals_bytes} $ jmp __frame_restore_{first_register}
    tick: push r0 $ in r0, SREG $ push r0 $ push r1 $ clr r1
        ldi r21, 1
        pop r1 $ pop r0 $ out SREG, r0 $ pop r0 $ reti
    {ROUTINES}",
        load_all = load(&CALL_SAVED_REGISTERS, 100),
        overwrite_saved = load(&saved_registers, 7),
    )
}

#[test]
fn shared_prologues_and_epilogues_restore_the_registers_and_the_stack_pointer() {
    for first_register in LOWEST_REGISTERS {
        for locals_bytes in [0, 1, 5, 63, 64, 200, 255] {
            let image = assemble(&generate_frame_program(first_register, locals_bytes));
            let mut uno = Uno::with_image(image, Fidelity::DataSheet);
            uno.run_ms(10);
            let case = format!("first register {first_register}, {locals_bytes} bytes of locals");
            assert_eq!(uno.peek(0x145), 1, "the program did not finish: {case}");
            for register in CALL_SAVED_REGISTERS {
                let value = uno.peek(0x100 + u16::from(register));
                assert_eq!(value, register + 100, "r{register}: {case}");
            }
            let stack_pointer = [uno.peek(0x140), uno.peek(0x141)];
            assert_eq!(stack_pointer, [0xff, 0x08], "{case}");
            assert_eq!(uno.peek(0x142), 0, "r1");
            let mismatch_count = uno.peek(0x143);
            assert_eq!(mismatch_count, 0, "r28 is not the stack pointer: {case}");
            let was_interrupted = uno.peek(0x144);
            assert_eq!(was_interrupted, 1, "the timer never fired: {case}");
        }
    }
}
