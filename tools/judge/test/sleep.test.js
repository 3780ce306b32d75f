import assert from 'node:assert/strict';
import test from 'node:test';

import { extendInterruptEntry } from '../src/corrections/interrupt-entry.js';
import { delayInterruptAfterEnable } from '../src/corrections/interrupt-after-enable.js';
import { simulateSleep } from '../src/corrections/sleep.js';
import { formatFaultFixed, makeUno, runProgram } from './program.js';

// Timer 1 matches at 200; until then, main repeats a loop that begins with SLEEP. The handler stores the timer's count
// in r20 and the number of completed iterations in r21.
const program = (sleepMode) => `
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
    ldi r18, ${sleepMode}
    out 0x33, r18     ; SMCR
    ldi r18, 1
    sts 0x81, r18     ; TCCR1B: clock
    sei
  again:
    sleep
    inc r16
    nop
    nop
    rjmp again`;

const SLEEP_AND_INTERRUPTS = [extendInterruptEntry, delayInterruptAfterEnable, simulateSleep];

test('SLEEP lasts until an interrupt', () => {
  const countIterations = (corrections) => runProgram(corrections, program(1), 400).cpu.data[21];
  assert.notEqual(countIterations([]), 0, formatFaultFixed('sleep.js'));
  assert.equal(countIterations([simulateSleep]), 0);
});

test('SLEEP does nothing unless SE is set', () => {
  assert.notEqual(runProgram([simulateSleep], program(0), 400).cpu.data[21], 0);
});

test('the response to an interrupt from sleep takes eight cycles', () => {
  const { data } = runProgram(SLEEP_AND_INTERRUPTS, program(1), 400).cpu;
  // LDS reads in its second cycle.
  assert.equal(data[20], 200 + 8 + 1);
});

test('sleep is simulated event by event', () => {
  const board = makeUno(SLEEP_AND_INTERRUPTS, 'ldi r16, 1\n out 0x33, r16\n sei\n sleep\n');
  let sleepStepCount = 0;
  let passTime = null;
  Object.defineProperty(board, 'passTimeAsleep', {
    get: () => passTime,
    set: (passTimeAsleep) => {
      passTime = () => {
        sleepStepCount += 1;
        passTimeAsleep();
      };
    },
  });
  board.run(16_000_000);
  assert.ok(sleepStepCount > 0 && sleepStepCount < 10, `${sleepStepCount} steps of sleep`);
  assert.equal(board.cpu.cycles, 16_000_000);
});
