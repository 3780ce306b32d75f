// The user's own robot: opening a link or another robot puts it aside and never erases it.
import { kept, type SavedChanges } from '../kept';
import type { Session } from '../session';
import type { Troubles } from './troubles';

/** The name in a robot.toml. */
const nameIn = (toml: string) => /^name\s*=\s*["'](.+?)["']/m.exec(toml)?.[1] ?? 'robot';

export class OwnRobot {
  /** `choose` loads a robot by its file name; `list` shows the names of the robots that are put aside. */
  constructor(
    private readonly session: () => Session,
    private readonly troubles: Troubles,
    private readonly choose: (file: string) => Promise<void>,
    private readonly list: (names: string[]) => void,
  ) {
    this.show();
  }

  /**
   * Puts the user's previous robot aside if it was changed and another robot has replaced it, and offers to restore
   * it.
   */
  putAside(previous: SavedChanges | null): void {
    if (!previous || previous.toml === previous.original || previous.toml === this.session().toml) return;
    this.setAside([previous, ...kept.aside().filter(({ toml }) => toml !== previous.toml)]);
    this.troubles.say('own', 'This is another robot. Your own one is put aside, and stays in the list of robots.', { label: 'Back to my own robot', act: () => void this.restore() });
  }

  /** Restores a robot that was put aside, and puts the current one aside. */
  async restore(index = 0): Promise<void> {
    const robotsAside = kept.aside();
    const ownRobot = robotsAside[index];
    this.troubles.say('own', null);
    if (!ownRobot) return;
    const previous = kept.get();
    await this.choose(ownRobot.file);
    const session = this.session();
    // If its file has changed since, the stored text itself is loaded.
    if (!(await session.recall(ownRobot)) && (await session.change(ownRobot.toml))) return;
    this.setAside(robotsAside.filter((_, n) => n !== index));
    this.putAside(previous);
  }

  private setAside(robots: SavedChanges[]): void {
    kept.setAside(robots);
    this.show();
  }

  private show(): void {
    this.list(kept.aside().map(({ toml }) => nameIn(toml)));
  }
}
