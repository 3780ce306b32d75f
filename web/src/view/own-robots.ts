// The user's own robots: when the user opens a link or another robot, the changed robot is put aside.
import { browserStorage, type SavedChanges } from '../browser-storage';
import type { Session } from '../session';
import type { ProblemList } from './problems';

const readName = (toml: string) => /^name\s*=\s*["'](.+?)["']/m.exec(toml)?.[1] ?? 'robot';

export class OwnRobots {
  /** The robots in the list; another tab may have changed the stored robots since. */
  private listedRobots: SavedChanges[] = [];

  /**
   * `loadFile` loads a robot by its file name, and returns false if another robot is chosen meanwhile; `showNames`
   * shows the names of the robots put aside.
   */
  constructor(
    private readonly session: Session,
    private readonly problems: ProblemList,
    private readonly loadFile: (file: string) => Promise<boolean>,
    private readonly showNames: (names: string[]) => void,
  ) {
    this.updateList();
  }

  /** If another robot has replaced a changed robot, puts the changed robot aside and offers to restore it. */
  putAside(previousRobot: SavedChanges | null): void {
    if (!previousRobot || previousRobot.toml === previousRobot.original || previousRobot.toml === this.session.robot.toml) return;
    this.storeList([previousRobot, ...browserStorage.getRobotsAside().filter(({ toml }) => toml !== previousRobot.toml)]);
    this.problems.setMessage('own', 'This is another robot. Your own robot is put aside and stays in the list of robots.', { label: 'Back to my own robot', action: () => void this.restore() });
  }

  /** Restores the robot with this index in the list, and puts the current robot aside. */
  async restore(index = 0): Promise<void> {
    const ownRobot = this.listedRobots[index];
    this.problems.setMessage('own', null);
    const { changes: previousRobot } = this.session.robot;
    // The user may have chosen another robot meanwhile. Without a file, no robot could be loaded.
    if (!(await this.loadFile(ownRobot.file)) || this.session.robot.file === '') return;
    // If the file has changed since the robot was put aside, the text is loaded without its floor, servos and supply.
    const isRestored = (await this.session.robot.restoreSaved(ownRobot)) || (await this.session.robot.change(ownRobot.toml)) === null;
    if (!isRestored) return this.putAside(previousRobot);
    this.storeList(browserStorage.getRobotsAside().filter(({ toml }) => toml !== ownRobot.toml));
    this.putAside(previousRobot);
  }

  private storeList(robots: SavedChanges[]): void {
    browserStorage.putRobotsAside(robots);
    this.updateList();
  }

  private updateList(): void {
    this.listedRobots = browserStorage.getRobotsAside();
    this.showNames(this.listedRobots.map(({ toml }) => readName(toml)));
  }
}
