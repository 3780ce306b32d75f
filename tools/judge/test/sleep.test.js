import assert from 'node:assert/strict';
import test from 'node:test';

import { interruptEntry } from '../src/corrections/interrupt-entry.js';
import { interruptWaits } from '../src/corrections/interrupt-waits.js';
import { sleep } from '../src/corrections/sleep.js';
import { fixed, run, uno } from './program.js';

// Timer 1 matches at 200; until then main sleeps or, in the other program, waits in a loop of NOPs.
// The handler keeps the count that it sees, in r20, and how often main went on before, in r21.
const program = (wait, mode) => `
    jmp main
    _LOC 0x2c         ; TIMER1_COMPA
    lds r20, 0x84     ; TCNT1L
    mov r21, r16
  stop:
    rjmp stop
    _LOC 0x68
  main:
    ldi r18, 200
    sts 0x88, r18     ; OCR1AL
    ldi r18, 2
    sts 0x6f, r18     ; TIMSK1
    ldi r18, ${mode}
    out 0x33, r18     ; SMCR
    ldi r18, 1
    sts 0x81, r18     ; TCCR1B: clock
    sei
  again:
    ${wait}
    inc r16
    nop
    nop
    rjmp again`;

test('SLEEP lasts until an interrupt', () => {
  const loopCount = (corrections) => run(corrections, program('sleep', 1), 400).cpu.data[21];
  assert.notEqual(loopCount([]), 0, fixed('sleep.js'));
  assert.equal(loopCount([sleep]), 0);
});

test('SLEEP does nothing unless SE is set', () => {
  assert.notEqual(run([sleep], program('sleep', 0), 400).cpu.data[21], 0);
});

test('an interrupt takes eight cycles from sleep', () => {
  const { data } = run([interruptEntry, interruptWaits, sleep], program('sleep', 1), 400).cpu;
  // LDS reads in its second cycle.
  assert.equal(data[20], 200 + 8 + 1);
});

test('sleep is simulated event by event, not cycle by cycle', () => {
  const board = uno([interruptEntry, interruptWaits, sleep], 'ldi r16, 1\n out 0x33, r16\n sei\n sleep\n');
  let steps = 0;
  let passTime = null;
  Object.defineProperty(board, 'sleep', {
    get: () => passTime,
    set: (sleep) => {
      passTime = () => {
        steps += 1;
        sleep();
      };
    },
  });
  board.run(16_000_000);
  assert.ok(steps > 0 && steps < 10, `${steps} steps`);
  assert.equal(board.cpu.cycles, 16_000_000);
});
