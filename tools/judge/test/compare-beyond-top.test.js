import assert from 'node:assert/strict';
import test from 'node:test';

import { ignoreCompareBeyondTop } from '../src/corrections/compare-beyond-top.js';
import { formatFaultFixed, runProgram } from './program.js';

// Timer 1 counts up to 99 and restarts; OCR1B is `compare`. The program copies the flags to r20.
const program = (compare) => `
    ldi r18, 99
    sts 0x88, r18     ; OCR1AL
    ldi r18, ${compare >> 8}
    sts 0x8b, r18     ; OCR1BH
    ldi r18, ${compare & 0xff}
    sts 0x8a, r18     ; OCR1BL
    ldi r18, 9
    sts 0x81, r18     ; TCCR1B: clock, clear on match
  again:
    in r20, 0x16      ; TIFR1
    rjmp again`;

const OCF1A = 2;
const OCF1B = 4;

test('a compare value beyond the top never matches', () => {
  const runForFlags = (corrections, compare) => runProgram(corrections, program(compare), 1000).cpu.data[20];
  for (const value of [100, 1000, 0xffff]) {
    assert.equal(runForFlags([], value), OCF1A | OCF1B, formatFaultFixed('compare-beyond-top.js'));
    assert.equal(runForFlags([ignoreCompareBeyondTop], value), OCF1A);
  }
  for (const value of [0, 1, 50, 98, 99]) {
    assert.equal(runForFlags([ignoreCompareBeyondTop], value), OCF1A | OCF1B);
  }
});
