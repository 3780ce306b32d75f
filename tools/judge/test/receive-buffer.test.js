import assert from 'node:assert/strict';
import test from 'node:test';

import { addReceiveBuffer } from '../src/receive-buffer.js';
import { makeUno } from './program.js';

// The program enables the receiver, waits, reads three bytes into r20 to r22, and then the status into r24.
const PROGRAM = `
    ldi r16, 0x10
    sts 0xc1, r16     ; UCSR0B: RXEN
    ldi r17, 50
  wait:
    dec r17
    brne wait
    lds r20, 0xc6     ; UDR0
    lds r21, 0xc6
    lds r22, 0xc6
    lds r24, 0xc0     ; UCSR0A
  stop:
    rjmp stop`;

test('the receiver keeps three unread bytes in order and loses a fourth', () => {
  const board = makeUno([addReceiveBuffer], PROGRAM);
  assert.equal(board.receive(1), false, 'a receiver that is off accepts no byte');
  board.run(20);
  assert.deepEqual([11, 12, 13, 14].map((byte) => board.receive(byte)), [true, true, true, false]);
  board.run(1000);
  const { data } = board.cpu;
  assert.deepEqual([...data.subarray(20, 23)], [11, 12, 13]);
  assert.equal(data[24] & 0x80, 0, 'RXC must be clear');
});

test('only the status of a garbled byte reports the error', () => {
  const FE = 0x10;
  // The program copies the status with the garbled byte to r20, and the status after both bytes are read to r23.
  const statusFirst = PROGRAM.replaceAll('0xc6     ; UDR0', '0xc0');
  const program = statusFirst.replace('lds r22, 0xc6', 'lds r22, 0xc6\n    lds r23, 0xc0');
  const board = makeUno([addReceiveBuffer], program);
  board.run(20);
  board.receive(11, true);
  board.receive(12);
  board.run(1000);
  const { data } = board.cpu;
  assert.equal(data[20] & FE, FE);
  assert.equal(data[23] & FE, 0);
});
