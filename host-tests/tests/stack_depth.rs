//! Tests of the stack depth that is computed from machine code: compared with the known depth of programs,
//! and with measured depths.

use lizard_host::bench::{StackDepth, StackError};
use lizard_host_tests::avr_gcc::{assemble, compile_c};
use lizard_linker::ROUTINES;
use simulated_uno::{Fidelity, Image, Uno};

/// Code that sets the stack pointer up as avr-libc does, from r28 and r29.
const BEGIN: &str = "
        ldi r28, 0xff $ ldi r29, 0x08
        out SPH, r29 $ out SPL, r28";

fn depth_of(image: &Image) -> StackDepth {
    StackDepth::of(image).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal_of(image: &Image) -> StackError {
    StackDepth::of(image).expect_err("it must be refused")
}

/// Runs a program for 10 ms and returns the depth that its stack reaches.
fn measure_depth(image: &Image) -> u16 {
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    uno.run_ms(10);
    uno.stack_used()
}

#[test]
fn pushes_calls_and_returns_are_added_up_along_the_deepest_way() {
    // start calls one (2), which pushes 3 and calls two (2), which pushes 1.
    let image = assemble(&format!(
        "{BEGIN}
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
    assert_eq!(depth_of(&image).max_depth(), 2 + 3 + 2 + 1);
    assert_eq!(measure_depth(&image), 8);
    // There is no static data, so all of SRAM except these bytes is left.
    assert_eq!(depth_of(&image).margin(), 2048 - 8);
}

#[test]
fn frames_small_and_large_count_and_so_does_a_jump_at_the_end_of_a_function() {
    for bytes in [1u16, 20, 63, 64, 300] {
        let reserve = match bytes {
            0..64 => format!("sbiw r28, {bytes}"),
            _ => format!("subi r28, lo8({bytes}) $ sbci r29, hi8({bytes})"),
        };
        let release = match bytes {
            0..64 => format!("adiw r28, {bytes}"),
            _ => format!("subi r28, lo8(-{bytes}) $ sbci r29, hi8(-{bytes})"),
        };
        let set_pointer = "in r0, SREG $ cli $ out SPH, r29 $ out SREG, r0 $ out SPL, r28";
        let image = assemble(&format!(
            "{BEGIN}
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
        assert_eq!(depth_of(&image).max_depth(), 2 + 2 + bytes + 2, "{bytes}");
        assert_eq!(measure_depth(&image), 2 + 2 + bytes + 2, "{bytes}");
    }
}

#[test]
fn the_deepest_interrupt_counts_once() {
    let image = assemble(&format!(
        "jmp start
        .org 0x2c
        jmp shallow
        jmp deep
        .org 0x68
    start: {BEGIN}
        push r16
    end: rjmp end
    shallow: push r0 $ pop r0 $ reti
    deep: push r0 $ push r1 $ rcall more $ pop r1 $ pop r0 $ reti
    more: push r2 $ pop r2 $ ret"
    ));
    let depth = depth_of(&image);
    assert_eq!((depth.main, depth.handler), (1, 2 + 2 + 2 + 1));
}

#[test]
fn compiled_c_is_followed_and_no_run_gets_deeper() {
    let image = compile_c(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        static volatile unsigned char out;
        ISR(TIMER1_COMPA_vect) { out += TCNT1L; }
        __attribute__((noinline)) static unsigned char sum(const volatile unsigned char *all) {
            unsigned char s = 0;
            for (unsigned char i = 0; i < 100; i++) s += all[i];
            return s;
        }
        __attribute__((noinline)) static unsigned char fill(unsigned char n) {
            volatile unsigned char all[100];
            for (unsigned char i = 0; i < 100; i++) all[i] = n / (i + 1);
            return sum(all);
        }
        int main(void) {
            OCR1A = 999; TIMSK1 = 2; TCCR1B = 9;
            sei();
            for (;;) out = fill(out);
        }",
    );
    let (worst_depth, measured_depth) = (depth_of(&image).max_depth(), measure_depth(&image));
    assert!(
        measured_depth > 100 && measured_depth <= worst_depth,
        "{measured_depth} of {worst_depth}"
    );
    assert!(
        worst_depth - measured_depth < 20,
        "{measured_depth} of {worst_depth}"
    );
}

#[test]
fn a_function_that_calls_itself_is_refused_by_name() {
    let image = compile_c(
        "#include <avr/io.h>
        __attribute__((noinline)) void deeper(unsigned char n) {
            GPIOR0 = n;
            if (n) deeper(n - 1);
            GPIOR1 = n;
        }
        int main(void) { for (;;) deeper(PINB); }",
    );
    let error = refusal_of(&image).to_string();
    assert!(
        error.contains("deeper") && error.contains("calls itself"),
        "{error}"
    );
}

#[test]
fn a_call_of_a_computed_address_is_refused_by_name() {
    let image = compile_c(
        "#include <avr/io.h>
        static void one(void) { GPIOR0 = 1; }
        static void two(void) { GPIOR0 = 2; }
        static void (*volatile which)(void);
        __attribute__((noinline)) void choose(void) { which(); GPIOR1 = 1; }
        int main(void) { which = PINB ? one : two; for (;;) choose(); }",
    );
    let error = refusal_of(&image).to_string();
    assert!(
        error.contains("choose") && error.contains("computes"),
        "{error}"
    );
    for jump in ["ijmp", "icall"] {
        let image = assemble(&format!("{BEGIN}\n{jump}\nend: rjmp end"));
        assert!(
            refusal_of(&image).to_string().contains("computes"),
            "{jump}"
        );
    }
}

#[test]
fn code_without_a_bound_is_refused() {
    let programs = [
        ("again: push r16 $ rjmp again", "more or less"),
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
        ("nop", "runs out"),
    ];
    for (program, reason) in programs {
        let error = refusal_of(&assemble(&format!("{BEGIN}\n{program}"))).to_string();
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
    let error = refusal_of(&image).to_string();
    assert!(error.contains("lets interrupts into"), "{error}");
}

#[test]
fn a_handler_that_lets_others_in_forever_lies_below_the_deepest_of_them() {
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
    let depth = depth_of(&image);
    assert_eq!(
        (depth.main, depth.handler, depth.nonreturning_handler),
        (0, 2 + 3, 2 + 1)
    );
    assert_eq!(depth.max_depth(), 8);
}

#[test]
fn shared_beginnings_and_ends_count_what_they_save_and_make_room_for() {
    for (first_register, saved_bytes, room_bytes) in [(2, 18, 0), (14, 6, 5), (18, 2, 200)] {
        let image = assemble(&format!(
            "{BEGIN}
            call framed
        end: rjmp end
        framed: ldi r26, {room_bytes} $ call __frame_save_{first_register}
            std Y+1, r16
            call leaf
            ldi r26, {room_bytes} $ jmp __frame_restore_{first_register}
        leaf: ret
        {ROUTINES}"
        ));
        // On the stack are the return address of `framed`, the saved registers, the room, and below the room the
        // return address of `leaf`.
        assert_eq!(
            depth_of(&image).max_depth(),
            2 + saved_bytes + room_bytes + 2,
            "{first_register}"
        );
        assert_eq!(
            measure_depth(&image),
            2 + saved_bytes + room_bytes + 2,
            "{first_register}"
        );
    }
}

#[test]
fn a_shared_end_that_does_not_fit_its_beginning_is_refused() {
    for (first_register, room_bytes) in [(16, 5), (14, 6)] {
        let image = assemble(&format!(
            "{BEGIN}
            call framed
        end: rjmp end
        .type framed, @function
        framed: ldi r26, 5 $ call __frame_save_14
            ldi r26, {room_bytes} $ jmp __frame_restore_{first_register}
        {ROUTINES}"
        ));
        let error = refusal_of(&image);
        assert_eq!(error.function, "framed");
        assert_eq!(error.reason, "restores other registers than it saved");
    }
}
