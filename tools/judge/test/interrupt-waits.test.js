import assert from 'node:assert/strict';
import test from 'node:test';

import { delayInterruptAfterEnable } from '../src/corrections/interrupt-waits.js';
import { fixedMessage, runProgram } from './program.js';

// Both compare interrupts of timer 0 are pending when interrupts are switched on. Then main counts in r16, and the
// handlers copy that count to r20 and r21.
const program = (switchOn) => `
    jmp main
    _LOC 0x38         ; TIMER0_COMPA
    mov r20, r16
    reti
    _LOC 0x3c         ; TIMER0_COMPB
    mov r21, r16
    reti
    _LOC 0x68
  main:
    ldi r17, 3
    out 0x27, r17     ; OCR0A
    out 0x28, r17     ; OCR0B
    ldi r17, 6
    sts 0x6e, r17     ; TIMSK0: both interrupts
    ldi r17, 1
    out 0x25, r17     ; TCCR0B: clock
    ldi r18, 0x80
    nop
    nop
    nop
    nop
    ${switchOn}
    inc r16
    inc r16
    inc r16
  stop:
    rjmp stop`;

const countsInHandlers = (corrections, switchOn) =>
  runProgram(corrections, program(switchOn), 100).cpu.data.slice(20, 22);

// The data address of SREG is 0x5f.
const pointZBelowSreg = 'ldi r30, 0x5e\n ldi r31, 0\n';
const [std, st] = [`${pointZBelowSreg} std Z+1, r18`, `${pointZBelowSreg} inc r30\n st Z, r18`];
for (const switchOn of ['sei', 'out 0x3f, r18', 'sts 0x5f, r18', std, st]) {
  test(`one instruction runs between \`${switchOn}\` and an interrupt, and one between two interrupts`, () => {
    assert.deepEqual([...countsInHandlers([], switchOn)], [0, 0], fixedMessage('interrupt-waits.js'));
    assert.deepEqual([...countsInHandlers([delayInterruptAfterEnable], switchOn)], [1, 2]);
  });
}
