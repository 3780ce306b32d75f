import assert from 'node:assert/strict';
import test from 'node:test';

import { holdEepromInterrupt } from '../src/corrections/eeprom-ready.js';
import { formatFaultFixed, runProgram } from './program.js';

// The interrupt handler counts its calls in r20 and starts writing a byte in each call.
const program = `
    jmp main
    _LOC 0x58         ; EE_READY
    inc r20
    out 0x20, r20     ; EEDR
    sbi 0x1f, 2       ; EEMPE
    sbi 0x1f, 1       ; EEPE
    reti
    _LOC 0x68
  main:
    ldi r16, 8
    out 0x1f, r16     ; EECR: EERIE
    sei
  again:
    rjmp again`;

test('the EEPROM interrupt waits until the write ends', () => {
  // A byte takes 3.4 ms, so the third call comes after 6.8 ms; the run ends after 10 ms.
  const countCalls = (corrections) => runProgram(corrections, program, 160_000).cpu.data[20];
  assert.ok(countCalls([]) > 3, formatFaultFixed('eeprom-ready.js'));
  assert.equal(countCalls([holdEepromInterrupt]), 3);
});
