import assert from 'node:assert/strict';
import test from 'node:test';

import { interruptEntry } from '../src/corrections/interrupt-entry.js';
import { fixed, run } from './program.js';

// The timer is read before an interrupt, in r16, and first thing in its handler, in r17.
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

/** Cycles of the entry: between the readings there are also LDS, 2, and SEI, 1. */
function entryCycles(corrections) {
  const { data } = run(corrections, program, 100).cpu;
  return data[17] - data[16] - 3;
}

test('an interrupt is entered in four cycles', () => {
  assert.equal(entryCycles([]), 2, fixed('interrupt-entry.js'));
  assert.equal(entryCycles([interruptEntry]), 4);
});
