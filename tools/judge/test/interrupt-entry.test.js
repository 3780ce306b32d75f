import assert from 'node:assert/strict';
import test from 'node:test';

import { extendInterruptEntry } from '../src/corrections/interrupt-entry.js';
import { formatFaultFixed, runProgram } from './program.js';

// The program reads the timer into r16 before an interrupt; the handler's first instruction reads it into r17.
const program = `
    jmp main
    _LOC 0x4c         ; USART_UDRE
    lds r17, 0x84     ; TCNT1L
  stop:
    rjmp stop
    _LOC 0x68
  main:
    ldi r18, 1
    sts 0x81, r18     ; TCCR1B: clock
    ldi r18, 0x28
    sts 0xc1, r18     ; UCSR0B: transmitter and its interrupt
    nop
    lds r16, 0x84     ; TCNT1L
    sei
    rjmp stop`;

/**
 * Returns the cycles of the interrupt response: those between the two readings, minus those of LDS (2) and SEI (1).
 * Without the correction interrupt-after-enable.js, no instruction runs between SEI and the interrupt.
 */
function measureEntryCycles(corrections) {
  const { data } = runProgram(corrections, program, 100).cpu;
  return data[17] - data[16] - 3;
}

test('the response to an interrupt takes four cycles', () => {
  assert.equal(measureEntryCycles([]), 2, formatFaultFixed('interrupt-entry.js'));
  assert.equal(measureEntryCycles([extendInterruptEntry]), 4);
});
