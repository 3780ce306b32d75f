// Puts an edited gait into the page's robot and starts it in the simulation.
import { type EditedGait, type Refusal, refuse } from '../robot';
import type { Session } from '../session';

/** Simulated time after which a restarted robot stands, ms. */
const WAKE_MS = 2500;

/** Puts the gait into the session's robot. A real board has the gait only after the robot is written to it. */
export async function applyGait(session: Session, gait: EditedGait): Promise<Refusal | null> {
  return session.robot.change(session.robot.wasm.putGait(session.robot.toml, gait));
}

/**
 * Puts the gait into the session's robot, restarts the simulated board and starts the gait. Refuses a real board, which
 * has only the gaits that were written to it.
 */
export async function driveGait(session: Session, gait: EditedGait): Promise<Refusal | null> {
  const refusal = await restartWithGait(session, gait);
  if (!refusal) await session.board.drive(gait.name.replaceAll('-', ' '));
  return refusal;
}

/**
 * Puts the gait into the session's robot, restarts the simulated board and waits until the robot stands. Refuses a real
 * board.
 */
export async function restartWithGait(session: Session, gait: EditedGait): Promise<Refusal | null> {
  if (session.board.isReal) return refuse('A real board has only the gaits that were written to it. Write this gait to the board, or return to the simulation to try it.');
  const refusal = await applyGait(session, gait);
  if (refusal) return refusal;
  const { dialogue } = session.board;
  await session.board.link.wait(WAKE_MS);
  return dialogue.isClosed ? refuse('The gait was not started, because the robot was changed meanwhile.') : null;
}
