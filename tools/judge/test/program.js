// Test helpers that run small AVR programs on avr8js with chosen corrections.
import assembler from 'avr8js/dist/cjs/utils/assembler.js';

import { Uno } from '../src/uno.js';

/** Makes an Uno with an assembled program in flash. In the source, `_LOC n` continues at byte address n. */
export function makeUno(corrections, source) {
  const { bytes, errors } = assembler.assemble(source);
  if (errors.length > 0) throw new Error(`the program cannot be assembled: ${JSON.stringify(errors)}`);
  const board = new Uno(corrections);
  board.flash.set(bytes);
  return board;
}

/** Makes an Uno with a program, runs it up to a cycle and returns it. */
export function runProgram(corrections, source, endCycle) {
  const board = makeUno(corrections, source);
  board.run(endCycle);
  return board;
}

/** Returns the state of a board's processor: its cycle, its program counter and its memory. */
export const stateOf = ({ cpu }) => ({ cycles: cpu.cycles, pc: cpu.pc, data: [...cpu.data] });

/** Returns the message of a test that fails because avr8js no longer has a fault. */
export const fixedMessage = (file) =>
  `avr8js has fixed this fault: remove tools/judge/src/corrections/${file}, its test and its line in docs/judges.md`;
