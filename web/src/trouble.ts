// What can go wrong, by its cause: a sentence about one is withdrawn only when that one is gone.

/**
 * `robot`: a robot's file. `line`: a line that is not answered. `port`: the port of a board, or the board
 * itself is gone. `board`: a board without this firmware. `simulation`: the simulated UNO has
 * stopped. `page`: the page cannot begin.
 */
export type Cause = 'robot' | 'line' | 'port' | 'board' | 'simulation' | 'page';

/** The sentence of anything thrown. */
export function sentence(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
