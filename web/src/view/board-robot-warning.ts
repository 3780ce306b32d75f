// A warning that the board's robot differs from the page's robot, which makes the drawing and the predictions wrong.
// The view searches for the board's robot and offers it.
import { effect } from '@preact/signals-core';

import { files } from '../files';
import { browserStorage, type SavedChanges } from '../browser-storage';
import { isRefused, Robot } from '../robot';
import type { Session } from '../session';
import { formatRobotName } from './setup/board';
import type { ProblemList } from './problems';

/** A robot that the page can show: its file name and its robot.toml, which the user may have changed. */
type KnownRobot = Pick<SavedChanges, 'file' | 'toml'>;

/** Shows a message while the board has a different robot; `showRobot` loads a robot into the page. */
export function warnOfBoardRobot(session: Session, problems: ProblemList, showRobot: (robot: KnownRobot) => void): void {
  /** An instance that only reads robots: an instance has one robot, and the page's instance must keep its robot. */
  const reader = new Robot();
  const update = async () => {
    const { otherRobot } = session.program;
    if (!session.board.isReal || !otherRobot) return problems.setMessage('other', null);
    const knownRobot = await findByHash(reader, otherRobot.hash);
    if (session.program.otherRobot?.hash !== otherRobot.hash) return;
    const message = `The ${session.board.link.name} has another robot, ${otherRobot.name}, but the page draws and predicts ${formatRobotName(session.robot)}.`;
    if (!knownRobot) return problems.setMessage('other', `${message} It is not among the page’s robots: open its robot.toml in Build, or write this robot.`);
    problems.setMessage('other', message, { label: `Show ${otherRobot.name}`, action: () => showRobot(knownRobot) });
  };
  effect(() => void update());
}

/**
 * Finds the robot with this hash among the user's robots put aside and the page's own robots; returns null if none
 * has this hash.
 */
async function findByHash(reader: Robot, hash: string): Promise<KnownRobot | null> {
  const hasHash = (toml: string) => {
    const result = reader.load(toml);
    return !isRefused(result) && result.hash === hash;
  };
  const ownRobot = browserStorage.getRobotsAside().find(({ toml }) => hasHash(toml));
  if (ownRobot) return ownRobot;
  const { all } = await files.robots().catch(() => ({ all: [] }));
  for (const file of all) {
    const toml = await files.toml(file).catch(() => '');
    if (hasHash(toml)) return { file, toml };
  }
  return null;
}
