import assert from 'node:assert/strict';
import test from 'node:test';

import { eepromReady } from '../src/corrections/eeprom-ready.js';
import { fixed, run } from './program.js';

// The handler counts its calls in r20 and begins to write a byte in each.
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
  // 3.4 ms for each.
  const callCount = (corrections) => run(corrections, program, 160_000).cpu.data[20];
  assert.ok(callCount([]) > 3, fixed('eeprom-ready.js'));
  assert.equal(callCount([eepromReady]), 3);
});
