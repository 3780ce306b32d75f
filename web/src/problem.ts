// The causes of problems. A problem's message stays until its cause is gone.

/**
 * The cause of a problem. `robot`: a robot file cannot be loaded. `own`: the user's robot was put aside. `line`: a line
 * got no answer. `port`: a port cannot be opened, or its board is gone. `board`: this firmware does not answer.
 * `other`: the board has another robot. `fault`: the robot has stopped by itself. `simulation`: the simulated UNO has
 * stopped. `page`: the page cannot start, or a part of it does not work.
 */
export type Cause = 'robot' | 'own' | 'line' | 'port' | 'board' | 'other' | 'fault' | 'simulation' | 'page';

/** Returns the message of a thrown value, which may not be an `Error`. */
export const getMessage = (error: unknown) =>
  error instanceof Error ? error.message : String(error);
