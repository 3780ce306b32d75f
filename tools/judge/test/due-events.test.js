import assert from 'node:assert/strict';
import test from 'node:test';

import { dueEvents } from '../src/corrections/due-events.js';
import { fixed, uno } from './program.js';

test('two events at one cycle come at one cycle', () => {
  const eventCycles = (corrections) => {
    const board = uno(corrections, 'again: rjmp again');
    const cycles = [];
    for (let i = 0; i < 2; i++) board.cpu.addClockEvent(() => cycles.push(board.cpu.cycles), 5);
    board.run(20);
    return cycles;
  };
  assert.deepEqual(eventCycles([]), [6, 8], fixed('due-events.js'));
  assert.deepEqual(eventCycles([dueEvents]), [6, 6]);
});

test('an interrupt is chosen when all events have come', () => {
  // Both have their flags set at once; the one with the lower address goes first.
  const board = uno([dueEvents], 'sei\nagain: rjmp again');
  const interruptAt = (address) => ({ address, flagRegister: 0x36, flagMask: 0, enableRegister: 0x20, enableMask: 1 });
  board.cpu.data[0x20] = 1;
  for (const address of [0x40, 0x20]) board.cpu.addClockEvent(() => board.cpu.setInterruptFlag(interruptAt(address)), 5);
  while (board.cpu.interruptsEnabled || board.cpu.cycles < 5) board.run(board.cpu.cycles + 1);
  assert.equal(board.cpu.pc, 0x20);
});
