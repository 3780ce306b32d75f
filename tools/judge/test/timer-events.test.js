import assert from 'node:assert/strict';
import test from 'node:test';

import { ignoreCompareBeyondTop } from '../src/corrections/compare-beyond-top.js';
import { wakeTimersAtTheirFlags } from '../src/timer-events.js';
import { readState, runProgram } from './program.js';

// Two interrupts of timer 1: their handlers store the timer's count in SRAM from X on, and the second also changes
// OCR1B by an odd step, so that every distance occurs. (A second timer would delay timer 1 in plain avr8js, which
// handles one event per instruction.)
const program = (mode, clock) => `
    jmp main
    _LOC 0x2c         ; TIMER1_COMPA
    rjmp a
    _LOC 0x30         ; TIMER1_COMPB
    rjmp b
    _LOC 0x68
  a:
    lds r20, 0x84     ; TCNT1L
    lds r21, 0x85
    st X+, r20
    st X+, r21
    reti
  b:
    lds r20, 0x84
    st X+, r20
    lds r22, 0x8a     ; OCR1BL
    subi r22, 0x6b
    sts 0x8b, r23     ; OCR1BH
    sts 0x8a, r22
    reti
  main:
    ldi r26, 0
    ldi r27, 1
    ldi r18, 3
    sts 0x89, r18     ; OCR1AH
    ldi r18, 5
    sts 0x88, r18     ; OCR1AL
    ldi r18, 6
    sts 0x6f, r18     ; TIMSK1
    ldi r18, ${mode | clock}
    sts 0x81, r18     ; TCCR1B
    sei
  again:
    rjmp again`;

for (const [name, mode] of [['normal mode', 0], ['clear on match', 8]]) {
  for (const clock of [1, 2]) {
    test(`timer flags are set at the same cycles as in plain avr8js, ${name}, clock ${clock}`, () => {
      const [slow, fast] = [[ignoreCompareBeyondTop], [wakeTimersAtTheirFlags, ignoreCompareBeyondTop]].map((corrections) =>
        readState(runProgram(corrections, program(mode, clock), 300_000)),
      );
      const valueCount = slow.data[26] + 256 * slow.data[27] - 0x100;
      assert.ok(valueCount > 1, `${valueCount} stored values`);
      assert.deepEqual(fast, slow);
    });
  }
}
