// The WebAssembly module that writes to a board and calibrates its servos.
import type * as Board from '../generated/board';
import { files } from './files';

let modulePromise: Promise<typeof Board> | null = null;

/** Loads the module once. Throws an error with a message for the user. */
export function loadBoardModule(): Promise<typeof Board> {
  const load = async () => {
    const [board, module] = await Promise.all([import('../generated/board'), files.boardModule()]);
    board.initSync({ module });
    return board;
  };
  return (modulePromise ??= load().catch((error: unknown) => {
    modulePromise = null;
    throw error;
  }));
}
