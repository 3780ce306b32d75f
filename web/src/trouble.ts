// Problems by their cause: a message stays until its own cause is gone.

/**
 * `robot`: a robot's file. `own`: the user's robot was put aside. `line`: a line without an answer. `port`: the port
 * of a board, or the board is gone. `board`: a board without this firmware. `other`: a board with another robot.
 * `fault`: the robot has stopped by itself. `simulation`: the simulated UNO has stopped. `page`: the page cannot start.
 */
export type Cause = 'robot' | 'own' | 'line' | 'port' | 'board' | 'other' | 'fault' | 'simulation' | 'page';

/** Returns the message of anything that was thrown. */
export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
