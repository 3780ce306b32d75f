// The one place where a gait that was made comes to the robot that the page shows.
import type { Bars, Refused } from '../robot';
import type { Session } from '../session';

/** A robot that begins anew stands after this, ms of the simulation. */
const WAKES = 2500;

/**
 * Has the session's robot with this gait, and begins it. No image has it, so the simulation goes on with the core.
 * A board on USB keeps the gaits of its image: on that it is refused in a sentence.
 */
export async function tryGait(session: Session, bars: Bars, ask: (line: string) => Promise<unknown>): Promise<Refused | null> {
  if (session.isReal) {
    return { refused: 'A board has the gaits of its image. Go back to the simulation to try this one, or copy it into robot.toml.', line: null, key: '' };
  }
  const refused = await session.change(session.robot.putGait(session.toml, bars));
  if (refused) return refused;
  const { link } = session;
  await link.wait(WAKES);
  if (session.link === link) await ask(bars.name.replaceAll('-', ' '));
  return null;
}
