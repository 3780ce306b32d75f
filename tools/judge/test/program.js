// Test helpers that run small AVR programs on avr8js with selected corrections.
import assembler from 'avr8js/dist/cjs/utils/assembler.js';

import { Uno } from '../src/uno.js';

/** Assembles a program and makes an Uno with it in flash. In the source, `_LOC n` continues at byte address n. */
export function makeUno(corrections, source) {
  const { bytes, errors } = assembler.assemble(source);
  if (errors.length > 0) throw new Error(`the program cannot be assembled: ${JSON.stringify(errors)}`);
  const board = new Uno(corrections);
  board.flash.set(bytes);
  return board;
}

/** Makes an Uno with a program, runs it to `endCycle` and returns it. */
export function runProgram(corrections, source, endCycle) {
  const board = makeUno(corrections, source);
  board.run(endCycle);
  return board;
}

/** Returns the state of a board's processor: its cycle, program counter and data memory. */
export const readState = ({ cpu }) => ({ cycles: cpu.cycles, pc: cpu.pc, data: [...cpu.data] });

/** Returns the failure message for the case that avr8js no longer has a fault. */
export const formatFaultFixed = (file) =>
  `avr8js has fixed this fault: remove tools/judge/src/corrections/${file}, its test and its line in docs/judges.md`;
