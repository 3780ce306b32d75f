import assert from 'node:assert/strict';
import test from 'node:test';

import { holdEepromInterrupt } from '../src/corrections/eeprom-ready.js';
import { fixedMessage, runProgram } from './program.js';

// The handler counts its calls in r20, and each call begins to write a byte.
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

test('the EEPROM interrupt waits until a byte is written', () => {
  // A byte takes 3.4 ms, so the third call comes after 6.8 ms; the run ends after 10 ms.
  const callCount = (corrections) => runProgram(corrections, program, 160_000).cpu.data[20];
  assert.ok(callCount([]) > 3, fixedMessage('eeprom-ready.js'));
  assert.equal(callCount([holdEepromInterrupt]), 3);
});
