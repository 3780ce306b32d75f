// The WebAssembly module that writes to a board and calibrates its servos.
import type * as Board from '../generated/board';
import { files } from './files';

let boardPromise: Promise<typeof Board> | null = null;

/** Loads the module once. Throws an error with a message for the user. */
export function loadBoard(): Promise<typeof Board> {
  const load = async () => {
    const [board, module] = await Promise.all([import('../generated/board'), files.board()]);
    board.initSync({ module });
    return board;
  };
  return (boardPromise ??= load().catch((error: unknown) => {
    boardPromise = null;
    throw error;
  }));
}
