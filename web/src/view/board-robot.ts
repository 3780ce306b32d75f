// A warning that the board has another robot than the page, so that the page draws and predicts it wrongly. The board's
// robot is searched for and offered.
import { effect } from '@preact/signals-core';

import { files } from '../files';
import { browserStorage } from '../browser-storage';
import { isRefused, Robot } from '../robot';
import type { Session } from '../session';
import { robotName } from './setup/board';
import type { ProblemList } from './problems';

/** A robot that the page can show: the name of its file, and its robot.toml, which the user may have changed. */
interface KnownRobot {
  file: string;
  toml: string;
}

export class BoardRobot {
  /** An instance only for reading robots: an instance has one robot, and the page's instance must keep its own. */
  private readonly reader = new Robot();

  /** `showRobot` loads a robot into the page. */
  constructor(
    private readonly session: Session,
    private readonly problems: ProblemList,
    private readonly showRobot: (robot: KnownRobot) => void,
  ) {
    effect(() => void this.update());
  }

  /** Reports that the board has another robot; removes the message if it does not. */
  private async update(): Promise<void> {
    const { session } = this;
    const { otherRobot } = session;
    if (!session.isReal || !otherRobot) return this.problems.setMessage('other', null);
    const knownRobot = await this.findByHash(otherRobot.hash);
    if (session.otherRobot?.hash !== otherRobot.hash) return;
    const message = `The ${session.link.name} has another robot, ${otherRobot.name}, and is drawn and predicted here as ${robotName(session)}.`;
    if (!knownRobot) return this.problems.setMessage('other', `${message} This page does not know it: open its robot.toml in Build, or write this one.`);
    this.problems.setMessage('other', message, { label: `Show ${otherRobot.name}`, action: () => this.showRobot(knownRobot) });
  }

  /**
   * Finds the robot with this hash among those that the user has put aside and those that come with the page; null if
   * none has it.
   */
  private async findByHash(hash: string): Promise<KnownRobot | null> {
    const hasHash = (toml: string) => {
      const answer = this.reader.read(toml);
      return !isRefused(answer) && answer.hash === hash;
    };
    const ownRobot = browserStorage.getPutAside().find(({ toml }) => hasHash(toml));
    if (ownRobot) return ownRobot;
    const { all } = await files.robots().catch(() => ({ all: [] }));
    for (const file of all) {
      const toml = await files.toml(file).catch(() => '');
      if (hasHash(toml)) return { file, toml };
    }
    return null;
  }
}
