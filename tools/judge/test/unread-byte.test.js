import assert from 'node:assert/strict';
import test from 'node:test';

import { keepUnreadByte } from '../src/corrections/unread-byte.js';
import { formatFaultFixed, makeUno } from './program.js';

/** Values of UCSR0B: RXEN0 and TXEN0, and also RXCIE0. */
const RECEIVER_AND_TRANSMITTER = 0x18;
const WITH_RECEIVE_INTERRUPT = 0x98;
/** Word address of the vector of the receive interrupt. */
const RECEIVE_VECTOR = 0x24;

// A byte arrives while the receiver is on; then the program writes UCSR0B. It copies the status to r16 before this
// write, and to r17 after it.
const program = (control) => `
    ldi r18, 0x10
    sts 0xc1, r18     ; UCSR0B: receiver on
    ldi r18, ${control}
  wait:
    lds r16, 0xc0     ; UCSR0A
    sbrs r16, 7       ; RXC0
    rjmp wait
    sts 0xc1, r18
    lds r17, 0xc0
    lds r19, 0xc6     ; UDR0
  stop:
    rjmp stop`;

/** Returns RXC0 after `control` is written to UCSR0B. */
function receiveFlagAfterWrite(corrections, control) {
  const board = makeUno(corrections, program(control));
  board.scheduleBytes([{ cycle: 50, byte: 0x41 }]);
  board.run(200);
  const { data } = board.cpu;
  assert.equal(data[16] >> 7, 1, 'the byte must have arrived');
  return data[17] >> 7;
}

test('an unread byte survives a write to UCSR0B that keeps the receiver on', () => {
  assert.equal(receiveFlagAfterWrite([], RECEIVER_AND_TRANSMITTER), 0, formatFaultFixed('unread-byte.js'));
  assert.equal(receiveFlagAfterWrite([keepUnreadByte], RECEIVER_AND_TRANSMITTER), 1);
});

test('the interrupt of an unread byte stays pending after a write to UCSR0B', () => {
  const board = makeUno([keepUnreadByte], program(WITH_RECEIVE_INTERRUPT));
  board.scheduleBytes([{ cycle: 50, byte: 0x41 }]);
  while (board.cpu.data[17] === 0) board.run(board.cpu.cycles + 1);
  assert.equal(board.cpu.nextInterrupt, RECEIVE_VECTOR);
});
