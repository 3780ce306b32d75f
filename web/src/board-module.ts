// The WebAssembly module that writes to a board and calibrates its servos.
import type * as Board from '../generated/board';
import { files } from './files';

/** Loads the module, unless it is already loaded. Throws an error with a message for the user. */
export async function loadBoardModule(): Promise<typeof Board> {
  const [board, module] = await Promise.all([import('../generated/board'), files.boardModule()]);
  board.initSync({ module });
  return board;
}
