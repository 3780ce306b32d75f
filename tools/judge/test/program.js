// Little AVR programs for the tests, run on avr8js with chosen corrections.
import assembler from 'avr8js/dist/cjs/utils/assembler.js';

import { Uno } from '../src/uno.js';

/** An Uno with a program, as its source, in flash. `_LOC n` continues at byte address n. */
export function uno(corrections, source) {
  const { bytes, errors } = assembler.assemble(source);
  if (errors.length > 0) throw new Error(`the program is wrong: ${JSON.stringify(errors)}`);
  const board = new Uno(corrections);
  board.flash.set(bytes);
  return board;
}

/** Runs a program for some cycles and returns the Uno. */
export function run(corrections, source, cycles) {
  const board = uno(corrections, source);
  board.run(cycles);
  return board;
}

/** The message of a test whose fault avr8js no longer has. */
export const fixed = (file) =>
  `avr8js has fixed this fault: tools/judge/src/corrections/${file} and its test can go, and its line in docs/judges.md`;
