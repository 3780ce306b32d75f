// What the page does with a board, in a WebAssembly module of its own: writes to it, and calibrates its servos.
import type * as Board from '../generated/board';
import { files } from './files';

let loading: Promise<typeof Board> | null = null;

/** Loads the module. Throws an error for the user. */
export function loadBoard(): Promise<typeof Board> {
  const load = async () => {
    const [board, module] = await Promise.all([import('../generated/board'), files.board()]);
    board.initSync({ module });
    return board;
  };
  return (loading ??= load().catch((error: unknown) => {
    loading = null;
    throw error;
  }));
}
