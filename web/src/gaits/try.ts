// The one place where a gait that was made comes to the robot, simulated or on a board.
import type { Made, Refused } from '../robot';
import type { Session } from '../session';

/** A robot that begins anew stands after this, ms of the simulation. */
const WAKES = 2500;

/** Has the session's robot with this gait. A board on USB gets it when its robot is written. */
export async function takeGait(session: Session, made: Made): Promise<Refused | null> {
  return session.change(session.robot.putGait(session.toml, made));
}

/**
 * Has the session's robot with this gait, and begins it on the simulated board, which begins anew. A board on USB
 * walks by what is written on it: on that it is refused in a sentence.
 */
export async function tryGait(session: Session, made: Made, ask: (line: string) => Promise<unknown>): Promise<Refused | null> {
  if (session.isReal) {
    return { refused: 'A board on USB has only the gaits that are written on it: write this one, or go back to the simulation to try it.', line: null, key: '' };
  }
  const refused = await takeGait(session, made);
  if (refused) return refused;
  const { link } = session;
  await link.wait(WAKES);
  if (session.link === link) await ask(made.name.replaceAll('-', ' '));
  return null;
}
