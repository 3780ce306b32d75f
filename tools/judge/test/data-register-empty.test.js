import assert from 'node:assert/strict';
import test from 'node:test';

import { keepTransmitInterruptPending } from '../src/corrections/data-register-empty.js';
import { formatFaultFixed, runProgram } from './program.js';

// The interrupt handler counts its calls in r16 and sends nothing.
const program = `
    jmp main
    _LOC 0x4c         ; USART_UDRE
    inc r16
    reti
    _LOC 0x68
  main:
    ldi r18, 0x28
    sts 0xc1, r18     ; UCSR0B: transmitter and its interrupt
    sei
  stop:
    rjmp stop`;

test('the transmit interrupt is repeated until a byte is written', () => {
  const countCalls = (corrections) => runProgram(corrections, program, 200).cpu.data[16];
  assert.equal(countCalls([]), 1, formatFaultFixed('data-register-empty.js'));
  assert.ok(countCalls([keepTransmitInterruptPending]) > 10);
});
