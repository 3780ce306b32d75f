// The user's own robots: when a link or another robot is opened, the changed robot is put aside and never lost.
import { browserStorage, type SavedChanges } from '../browser-storage';
import type { Session } from '../session';
import type { ProblemList } from './problems';

/** Returns the name of the robot in a robot.toml. */
const nameIn = (toml: string) => /^name\s*=\s*["'](.+?)["']/m.exec(toml)?.[1] ?? 'robot';

export class OwnRobot {
  /** `loadFile` loads a robot by its file name; `listNames` shows the names of the robots that are put aside. */
  constructor(
    private readonly session: Session,
    private readonly problems: ProblemList,
    private readonly loadFile: (file: string) => Promise<void>,
    private readonly listNames: (names: string[]) => void,
  ) {
    this.updateList();
  }

  /** Puts the previous robot aside and offers to restore it, if it was changed and another robot has replaced it. */
  putAside(previous: SavedChanges | null): void {
    if (!previous || previous.toml === previous.original || previous.toml === this.session.toml) return;
    this.storeAside([previous, ...browserStorage.getPutAside().filter(({ toml }) => toml !== previous.toml)]);
    this.problems.setMessage('own', 'This is another robot. Your own one is put aside, and stays in the list of robots.', { label: 'Back to my own robot', action: () => void this.restore() });
  }

  /** Restores the robot with this index among those that were put aside, and puts the current robot aside. */
  async restore(index = 0): Promise<void> {
    const robotsAside = browserStorage.getPutAside();
    const ownRobot = robotsAside[index];
    this.problems.setMessage('own', null);
    if (!ownRobot) return;
    const previous = browserStorage.getChanges();
    await this.loadFile(ownRobot.file);
    const session = this.session;
    // If the robot's file has changed since then, only the stored text is loaded.
    if (!(await session.restoreSaved(ownRobot)) && (await session.change(ownRobot.toml))) return;
    this.storeAside(robotsAside.filter((_, n) => n !== index));
    this.putAside(previous);
  }

  private storeAside(robots: SavedChanges[]): void {
    browserStorage.putRobotsAside(robots);
    this.updateList();
  }

  private updateList(): void {
    this.listNames(browserStorage.getPutAside().map(({ toml }) => nameIn(toml)));
  }
}
