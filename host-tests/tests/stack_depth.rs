//! Tests of the stack depth computed from machine code, which is compared with known and measured depths.

use std::fmt::Display;

use lizard_host::bench::{StackDepth, StackError};
use lizard_host_tests::assert_contains;
use lizard_host_tests::avr_gcc::{assemble, compile_c};
use lizard_linker::ROUTINES;
use simulated_uno::{Fidelity, Image, Uno};

/// Code that sets the stack pointer to the end of SRAM through r28 and r29, as in avr-libc.
const SET_STACK_POINTER: &str = "
        ldi r28, 0xff $ ldi r29, 0x08
        out SPH, r29 $ out SPL, r28";

fn compute_depth(image: &Image) -> StackDepth {
    StackDepth::compute(image).unwrap_or_else(|error| panic!("{error}"))
}

fn expect_error(image: &Image) -> StackError {
    StackDepth::compute(image).expect_err("the stack depth of the program has no bound")
}

/// Checks that the stack depth of a program has no bound, for a reason whose message contains all `parts`.
#[track_caller]
fn assert_unbounded(image: &Image, parts: &[&str]) {
    let error = expect_error(image).to_string();
    for part in parts {
        assert_contains(&error, part);
    }
}

/// Checks the computed and the measured stack depth of a program.
#[track_caller]
fn assert_depth(image: &Image, expected: u16, case_name: impl Display) {
    let depths = (compute_depth(image).max_depth(), measure_depth(image));
    assert_eq!(depths, (expected, expected), "{case_name}");
}

/// Runs a program for 10 ms and returns its stack depth.
fn measure_depth(image: &Image) -> u16 {
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    uno.run_ms(10);
    uno.stack_used()
}

#[test]
fn pushes_and_calls_add_up_along_the_deepest_path() {
    // The start code calls `one` (2 bytes). `one` pushes 3 bytes and calls `two` (2 bytes), which pushes 1 byte.
    let image = assemble(&format!(
        "{SET_STACK_POINTER}
        rcall one
        call two
    end: rjmp end
    one: push r16 $ push r16 $ push r16
        rcall two
        pop r16 $ pop r16 $ pop r16
        ret
    two: push r17
        sbrc r16, 0
        rjmp over
        sbis PINB, 2
        lds r16, 0x0100
    over: pop r17
        ret"
    ));
    assert_depth(&image, 2 + 3 + 2 + 1, "pushes and calls");
    // There is no static data, so the rest of SRAM is free.
    assert_eq!(compute_depth(&image).margin(), 2048 - 8);
}

#[test]
fn stack_frames_and_final_jumps_are_counted() {
    for frame_bytes in [1u16, 20, 63, 64, 300] {
        let reserve = match frame_bytes {
            0..64 => format!("sbiw r28, {frame_bytes}"),
            _ => format!("subi r28, lo8({frame_bytes}) $ sbci r29, hi8({frame_bytes})"),
        };
        let release = match frame_bytes {
            0..64 => format!("adiw r28, {frame_bytes}"),
            _ => format!("subi r28, lo8(-{frame_bytes}) $ sbci r29, hi8(-{frame_bytes})"),
        };
        let set_pointer = "in r0, SREG $ cli $ out SPH, r29 $ out SREG, r0 $ out SPL, r28";
        let image = assemble(&format!(
            "{SET_STACK_POINTER}
            call framed
        end: rjmp end
        framed: push r28 $ push r29
            in r28, SPL $ in r29, SPH $ {reserve} $ {set_pointer}
            std Y+1, r16
            call leaf
            {release} $ {set_pointer}
            pop r29 $ pop r28
            jmp last
        last: push r16 $ pop r16
        leaf: ret"
        ));
        assert_depth(&image, 2 + 2 + frame_bytes + 2, frame_bytes);
    }
}

#[test]
fn only_the_deepest_interrupt_handler_is_counted() {
    let image = assemble(&format!(
        "jmp start
        .org 0x2c
        jmp shallow
        jmp deep
        .org 0x68
    start: {SET_STACK_POINTER}
        push r16
    end: rjmp end
    shallow: push r0 $ pop r0 $ reti
    deep: push r0 $ push r1 $ rcall more $ pop r1 $ pop r0 $ reti
    more: push r2 $ pop r2 $ ret"
    ));
    let depth = compute_depth(&image);
    assert_eq!((depth.main, depth.handler), (1, 2 + 2 + 2 + 1));
}

#[test]
fn the_depth_of_compiled_c_is_an_upper_bound_near_the_measured_depth() {
    let image = compile_c(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        static volatile unsigned char out;
        ISR(TIMER1_COMPA_vect) { out += TCNT1L; }
        __attribute__((noinline)) static unsigned char sum(const volatile unsigned char *values) {
            unsigned char total = 0;
            for (unsigned char i = 0; i < 100; i++) total += values[i];
            return total;
        }
        __attribute__((noinline)) static unsigned char fill(unsigned char n) {
            volatile unsigned char values[100];
            for (unsigned char i = 0; i < 100; i++) values[i] = n / (i + 1);
            return sum(values);
        }
        int main(void) {
            OCR1A = 999; TIMSK1 = 2; TCCR1B = 9;
            sei();
            for (;;) out = fill(out);
        }",
    );
    let (computed_depth, measured_depth) =
        (compute_depth(&image).max_depth(), measure_depth(&image));
    let depths = format!("{measured_depth} of {computed_depth}");
    assert!(measured_depth > 100, "{depths}");
    assert!(measured_depth <= computed_depth, "{depths}");
    assert!(computed_depth - measured_depth < 20, "{depths}");
}

#[test]
fn the_error_for_recursion_names_the_function() {
    let image = compile_c(
        "#include <avr/io.h>
        __attribute__((noinline)) void deeper(unsigned char n) {
            GPIOR0 = n;
            if (n) deeper(n - 1);
            GPIOR1 = n;
        }
        int main(void) { for (;;) deeper(PINB); }",
    );
    assert_unbounded(&image, &["deeper", "calls itself"]);
}

#[test]
fn the_error_for_an_indirect_call_names_the_function() {
    let image = compile_c(
        "#include <avr/io.h>
        static void one(void) { GPIOR0 = 1; }
        static void two(void) { GPIOR0 = 2; }
        static void (*volatile chosen)(void);
        __attribute__((noinline)) void choose(void) { chosen(); GPIOR1 = 1; }
        int main(void) { chosen = PINB ? one : two; for (;;) choose(); }",
    );
    assert_unbounded(&image, &["choose", "computed address"]);
}

#[test]
fn code_without_a_bound_on_its_stack_is_refused() {
    let programs = [
        ("again: push r16 $ rjmp again", "different stack depths"),
        (
            "rcall one\nend: rjmp end\none: push r16 $ ret",
            "returns with",
        ),
        ("out SPL, r16\nend: rjmp end", "stack pointer"),
        ("sts 0x5d, r16\nend: rjmp end", "stack pointer"),
        (
            "movw r28, r16 $ out SPL, r28\nend: rjmp end",
            "stack pointer",
        ),
        ("nop", "runs beyond the end"),
        ("ijmp\nend: rjmp end", "computed address"),
        ("icall\nend: rjmp end", "computed address"),
    ];
    for (program, reason) in programs {
        let error = expect_error(&assemble(&format!("{SET_STACK_POINTER}\n{program}"))).to_string();
        assert!(error.contains(reason), "{program}: {error}");
    }
    let image = assemble(
        "jmp start
        .org 0x2c
        jmp handler
        .org 0x68
    start: rjmp start
    handler: sei $ reti",
    );
    assert_unbounded(&image, &["enables interrupts in"]);
}

#[test]
fn a_handler_that_enables_interrupts_and_never_returns_adds_to_the_deepest_handler() {
    let image = assemble(
        "jmp start
        .org 0x2c
        jmp handler
        jmp hung
        .org 0x68
    start: sei
    end: rjmp end
    handler: push r1 $ push r1 $ push r1 $ pop r1 $ pop r1 $ pop r1 $ reti
    hung: push r1 $ sei
    stay: rjmp stay",
    );
    let depth = compute_depth(&image);
    assert_eq!(
        (depth.main, depth.handler, depth.nonreturning_handler),
        (0, 2 + 3, 2 + 1)
    );
    assert_eq!(depth.max_depth(), 8);
}

#[test]
fn the_registers_and_locals_of_shared_prologues_are_counted() {
    for (first_register, saved_bytes, locals_bytes) in [(2, 18, 0), (14, 6, 5), (18, 2, 200)] {
        let image = assemble(&format!(
            "{SET_STACK_POINTER}
            call framed
        end: rjmp end
        framed: ldi r26, {locals_bytes} $ call __frame_save_{first_register}
            std Y+1, r16
            call leaf
            ldi r26, {locals_bytes} $ jmp __frame_restore_{first_register}
        leaf: ret
        {ROUTINES}"
        ));
        // The stack contains the return address of `framed`, the saved registers, the local variables, and the return
        // address of `leaf`.
        let expected = 2 + saved_bytes + locals_bytes + 2;
        assert_depth(&image, expected, first_register);
    }
}

#[test]
fn a_shared_epilogue_that_does_not_match_its_prologue_is_refused() {
    for (first_register, locals_bytes) in [(16, 5), (14, 6)] {
        let image = assemble(&format!(
            "{SET_STACK_POINTER}
            call framed
        end: rjmp end
        .type framed, @function
        framed: ldi r26, 5 $ call __frame_save_14
            ldi r26, {locals_bytes} $ jmp __frame_restore_{first_register}
        {ROUTINES}"
        ));
        let error = expect_error(&image);
        assert_eq!(error.function, "framed");
        assert_eq!(error.reason, "restores different registers than it saved");
    }
}
