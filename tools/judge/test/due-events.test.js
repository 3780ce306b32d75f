import assert from 'node:assert/strict';
import test from 'node:test';

import { handleAllDueEvents } from '../src/corrections/due-events.js';
import { formatFaultFixed, makeUno } from './program.js';

test('two events due at the same cycle are handled at the same cycle', () => {
  const recordEventCycles = (corrections) => {
    const board = makeUno(corrections, 'again: rjmp again');
    const cycles = [];
    for (let i = 0; i < 2; i++) board.cpu.addClockEvent(() => cycles.push(board.cpu.cycles), 5);
    board.run(20);
    return cycles;
  };
  assert.deepEqual(recordEventCycles([]), [6, 8], formatFaultFixed('due-events.js'));
  assert.deepEqual(recordEventCycles([handleAllDueEvents]), [6, 6]);
});

test('after all due events, the interrupt with the lowest address is served first', () => {
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
