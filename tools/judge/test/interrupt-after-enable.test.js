import assert from 'node:assert/strict';
import test from 'node:test';

import { delayInterruptAfterEnable } from '../src/corrections/interrupt-after-enable.js';
import { formatFaultFixed, runProgram } from './program.js';

// Both compare interrupts of timer 0 are pending when the program enables interrupts. After that, main counts its
// instructions in r16, and the handlers copy that count to r20 and r21.
const program = (enableInstruction) => `
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
    out 0x25, r17     ; TCCR0B: start, no prescaler
    ldi r18, 0x80
    nop
    nop
    nop
    nop
    ${enableInstruction}
    inc r16
    inc r16
    inc r16
  stop:
    rjmp stop`;

const runAndReadHandlerCounts = (corrections, enableInstruction) =>
  runProgram(corrections, program(enableInstruction), 100).cpu.data.slice(20, 22);

// The data address of SREG is 0x5f.
const pointZBelowSreg = 'ldi r30, 0x5e\n ldi r31, 0\n';
const [std, st] = [`${pointZBelowSreg} std Z+1, r18`, `${pointZBelowSreg} inc r30\n st Z, r18`];
for (const enableInstruction of ['sei', 'out 0x3f, r18', 'sts 0x5f, r18', std, st]) {
  test(`one instruction runs between \`${enableInstruction}\` and an interrupt, and between two interrupts`, () => {
    assert.deepEqual([...runAndReadHandlerCounts([], enableInstruction)], [0, 0], formatFaultFixed('interrupt-after-enable.js'));
    assert.deepEqual([...runAndReadHandlerCounts([delayInterruptAfterEnable], enableInstruction)], [1, 2]);
  });
}
