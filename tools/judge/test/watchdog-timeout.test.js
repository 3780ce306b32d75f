import assert from 'node:assert/strict';
import test from 'node:test';

import { applyNewWatchdogTimeout } from '../src/corrections/watchdog-timeout.js';
import { formatFaultFixed, runProgram } from './program.js';

// The watchdog interrupts after 64 ms. The handler counts its calls in r20 and sets a timeout of 16 ms.
const program = `
    jmp main
    _LOC 0x18         ; WDT
    inc r20
    ldi r17, 0x40     ; WDIE, 16 ms
    sts 0x60, r16
    sts 0x60, r17
    reti
    _LOC 0x68
  main:
    ldi r16, 0x18     ; WDCE, WDE
    ldi r17, 0x42     ; WDIE, 64 ms
    sts 0x60, r16     ; WDTCSR
    sts 0x60, r17
    sei
  again:
    rjmp again`;

test('a shorter timeout of the watchdog applies at once', () => {
  // The calls come after 64, 80 and 96 ms; the run ends after 104 ms.
  const countCalls = (corrections) => runProgram(corrections, program, 104 * 16_000).cpu.data[20];
  assert.equal(countCalls([]), 1, formatFaultFixed('watchdog-timeout.js'));
  assert.equal(countCalls([applyNewWatchdogTimeout]), 3);
});
