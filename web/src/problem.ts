// The causes of problems. The message of a problem stays until its cause is gone.

/**
 * The cause of a problem. `robot`: a robot's file cannot be loaded. `own`: the user's robot was put aside. `line`: a
 * line got no answer. `port`: a port cannot be opened, or its board is gone. `board`: no answer from this firmware.
 * `other`: the board has another robot. `fault`: the robot has stopped by itself. `simulation`: the simulated UNO has
 * stopped. `page`: the page cannot start.
 */
export type Cause = 'robot' | 'own' | 'line' | 'port' | 'board' | 'other' | 'fault' | 'simulation' | 'page';

/** Returns the message of a thrown value, which need not be an `Error`. */
export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
