// The user's own robots: when the user opens a link or another robot, the changed robot is put aside.
import { browserStorage, type SavedChanges } from '../browser-storage';
import type { Session } from '../session';
import type { ProblemList } from './problems';

const readName = (toml: string) => /^name\s*=\s*["'](.+?)["']/m.exec(toml)?.[1] ?? 'robot';

export class OwnRobots {
  /** The robots in the list; another page may have changed the stored robots since. */
  private listedRobots: SavedChanges[] = [];

  /** `loadFile` loads a robot by its file name; `listNames` shows the names of the robots put aside. */
  constructor(
    private readonly session: Session,
    private readonly problems: ProblemList,
    private readonly loadFile: (file: string) => Promise<void>,
    private readonly listNames: (names: string[]) => void,
  ) {
    this.updateList();
  }

  /** If another robot has replaced a changed robot, puts the changed robot aside and offers to restore it. */
  putAside(previous: SavedChanges | null): void {
    if (!previous || previous.toml === previous.original || previous.toml === this.session.toml) return;
    this.storeAside([previous, ...browserStorage.getRobotsAside().filter(({ toml }) => toml !== previous.toml)]);
    this.problems.setMessage('own', 'This is another robot. Your own robot is put aside and stays in the list of robots.', { label: 'Back to my own robot', action: () => void this.restore() });
  }

  /** Restores the robot with this index in the list, and puts the current robot aside. */
  async restore(index = 0): Promise<void> {
    const ownRobot = this.listedRobots[index];
    this.problems.setMessage('own', null);
    const { changes: previous } = this.session;
    await this.loadFile(ownRobot.file);
    // The user has chosen another robot meanwhile, whose file is still being loaded.
    if (this.session.file === '') return;
    // If the robot's file has changed meanwhile, only the stored text is loaded.
    if (!(await this.session.restoreSaved(ownRobot)) && (await this.session.change(ownRobot.toml))) return this.putAside(previous);
    this.storeAside(browserStorage.getRobotsAside().filter(({ toml }) => toml !== ownRobot.toml));
    this.putAside(previous);
  }

  private storeAside(robots: SavedChanges[]): void {
    browserStorage.putRobotsAside(robots);
    this.updateList();
  }

  private updateList(): void {
    this.listedRobots = browserStorage.getRobotsAside();
    this.listNames(this.listedRobots.map(({ toml }) => readName(toml)));
  }
}
