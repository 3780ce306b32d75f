// The user's own robot: a link, or the list of robots, puts it aside and never erases it.
import { kept, type SavedChanges } from '../kept';
import type { Session } from '../session';
import { element } from './canvas';
import type { Troubles } from './troubles';

const BACK = 'Back to my own robot';

export class OwnRobot {
  private readonly button = element<HTMLButtonElement>('robot-own');

  /** `choose` loads a robot of the list by its file name. */
  constructor(
    private readonly session: () => Session,
    private readonly troubles: Troubles,
    private readonly choose: (file: string) => Promise<void>,
  ) {
    this.button.addEventListener('click', () => void this.restore());
    this.button.textContent = BACK;
    this.button.hidden = kept.aside().length === 0;
  }

  /** Puts the changed robot of before aside, if another one has replaced it, and offers it. */
  replaced(before: SavedChanges | null): void {
    if (!before || before.toml === before.original || before.toml === this.session().toml) return;
    kept.setAside([before, ...kept.aside().filter(({ toml }) => toml !== before.toml)]);
    this.button.hidden = false;
    this.troubles.say('own', 'This is another robot. Your own one is put aside, and stays in Build, at robot.toml.', { label: BACK, act: () => void this.restore() });
  }

  private async restore(): Promise<void> {
    const [own, ...others] = kept.aside();
    this.troubles.say('own', null);
    if (!own) return;
    await this.choose(own.file);
    const session = this.session();
    // Its file may be another one by now.
    if (!(await session.recall(own)) && (await session.change(own.toml))) return;
    kept.setAside(others);
    this.button.hidden = others.length === 0;
  }
}
