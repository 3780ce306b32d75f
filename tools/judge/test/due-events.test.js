import assert from 'node:assert/strict';
import test from 'node:test';

import { handleAllDueEvents } from '../src/corrections/due-events.js';
import { fixedMessage, makeUno } from './program.js';

test('two events that are due at the same cycle are handled at the same cycle', () => {
  const eventCycles = (corrections) => {
    const board = makeUno(corrections, 'again: rjmp again');
    const cycles = [];
    for (let i = 0; i < 2; i++) board.cpu.addClockEvent(() => cycles.push(board.cpu.cycles), 5);
    board.run(20);
    return cycles;
  };
  assert.deepEqual(eventCycles([]), [6, 8], fixedMessage('due-events.js'));
  assert.deepEqual(eventCycles([handleAllDueEvents]), [6, 6]);
});

test('the interrupt with the lowest address is served first after all due events', () => {
  // Both interrupt flags are set at the same cycle.
  const board = makeUno([handleAllDueEvents], 'sei\nagain: rjmp again');
  const interruptAt = (address) => ({ address, flagRegister: 0x36, flagMask: 0, enableRegister: 0x20, enableMask: 1 });
  board.cpu.data[0x20] = 1;
  for (const address of [0x40, 0x20]) {
    board.cpu.addClockEvent(() => board.cpu.setInterruptFlag(interruptAt(address)), 5);
  }
  while (board.cpu.interruptsEnabled || board.cpu.cycles < 5) board.run(board.cpu.cycles + 1);
  assert.equal(board.cpu.pc, 0x20);
});
