import assert from 'node:assert/strict';
import test from 'node:test';

import { waitingByte } from '../src/corrections/waiting-byte.js';
import { fixed, uno } from './program.js';

// A byte comes while the receiver is on; then UCSR0B is written, and r16 and r17 get the status before
// and after.
const program = (control) => `
    ldi r18, 0x10
    sts 0xc1, r18     ; UCSR0B: receiver
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

function waitingFlag(corrections, control) {
  const board = uno(corrections, program(control));
  board.deliver([{ cycle: 50, byte: 0x41 }]);
  board.run(200);
  const { data } = board.cpu;
  assert.equal(data[16] >> 7, 1, 'the byte has come');
  return data[17] >> 7;
}

test('a waiting byte survives a write of UCSR0B if the receiver stays on', () => {
  assert.equal(waitingFlag([], 0x18), 0, fixed('waiting-byte.js'));
  assert.equal(waitingFlag([waitingByte], 0x18), 1);
});

test('the interrupt of a waiting byte stays pending, too', () => {
  const board = uno([waitingByte], program(0x98));
  board.deliver([{ cycle: 50, byte: 0x41 }]);
  while (board.cpu.data[17] === 0) board.run(board.cpu.cycles + 1);
  assert.equal(board.cpu.nextInterrupt, 0x24);
});
