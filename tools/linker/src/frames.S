; The prologues and epilogues that functions share.
;
; __frame_save_K is called with a number of bytes in r26. It saves the registers from rK to
; r17 and r28, r29, makes room for that many bytes, and points r29:r28 to them.
; __frame_restore_K is jumped to with the same number in r26. It undoes this and returns
; to the function's caller.
;
; Besides r26, r0 and the flags change. r1 is 0 before and after, as the calling convention
; requires; an interrupt handler clears r1 itself. The halves of the stack pointer are set with
; interrupts off; a pending interrupt is served only after the instruction that follows
; "out SREG".

#define SPL 0x3d
#define SPH 0x3e
#define SREG 0x3f

.macro routines first
    .section .text.__frame_save_\first, "ax", @progbits
    .global __frame_save_\first
    .type __frame_save_\first, @function
__frame_save_\first:
    ; The return address is on top of the stack.
    pop r1
    pop r0
    jmp __frame_push_\first
    .size __frame_save_\first, . - __frame_save_\first

    .section .text.__frame_restore_\first, "ax", @progbits
    .global __frame_restore_\first
    .type __frame_restore_\first, @function
__frame_restore_\first:
    in r28, SPL
    in r29, SPH
    add r28, r26
    adc r29, r1
    ; The number of saved bytes.
    ldi r26, 20 - \first
    jmp __frame_load_\first
    .size __frame_restore_\first, . - __frame_restore_\first
.endm

routines 2
routines 4
routines 6
routines 8
routines 10
routines 12
routines 14
routines 16
routines 18

    .section .text.__frame_push, "ax", @progbits
    .type __frame_push_2, @function
__frame_push_2:
    push r2
    push r3
__frame_push_4:
    push r4
    push r5
__frame_push_6:
    push r6
    push r7
__frame_push_8:
    push r8
    push r9
__frame_push_10:
    push r10
    push r11
__frame_push_12:
    push r12
    push r13
__frame_push_14:
    push r14
    push r15
__frame_push_16:
    push r16
    push r17
__frame_push_18:
    push r28
    push r29
    in r28, SPL
    in r29, SPH
    sub r28, r26
    brcc 1f
    dec r29
1:  in r26, SREG
    cli
    out SPH, r29
    out SREG, r26
    out SPL, r28
    push r0
    push r1
    clr r1
    ret
    .size __frame_push_2, . - __frame_push_2

    .section .text.__frame_load, "ax", @progbits
    .type __frame_load_2, @function
__frame_load_2:
    ldd r2, Y+18
    ldd r3, Y+17
__frame_load_4:
    ldd r4, Y+16
    ldd r5, Y+15
__frame_load_6:
    ldd r6, Y+14
    ldd r7, Y+13
__frame_load_8:
    ldd r8, Y+12
    ldd r9, Y+11
__frame_load_10:
    ldd r10, Y+10
    ldd r11, Y+9
__frame_load_12:
    ldd r12, Y+8
    ldd r13, Y+7
__frame_load_14:
    ldd r14, Y+6
    ldd r15, Y+5
__frame_load_16:
    ldd r16, Y+4
    ldd r17, Y+3
__frame_load_18:
    ldd r0, Y+2
    ldd r1, Y+1
    add r28, r26
    brcc 1f
    inc r29
1:  in r26, SREG
    cli
    out SPH, r29
    out SREG, r26
    out SPL, r28
    movw r28, r0
    clr r1
    ret
    .size __frame_load_2, . - __frame_load_2
