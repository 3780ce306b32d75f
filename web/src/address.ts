// The fragment of the page's address, the part after the #, names a room and a robot, so that a link or a bookmark
// keeps them. No server sees it.
import { pack } from './link-text';
import type { Session } from './session';

/** Delay from a change of the robot to the update of the address, ms: browsers limit the rate of updates. */
const UPDATE_DELAY_MS = 300;

/** Parses the fragment of an address: `room`, and the robot as `file`, its name, or as `robot`, its packed text. */
export const addressParts = (hash: string) => new URLSearchParams(hash.slice(1));

/** The `state` of a browser history entry that the page wrote; it names a room and the robot at the time of writing. */
export const PAGE_ENTRY = 'own';

export class Address {
  private timer = 0;
  /** True once the address that the page was opened with has been read. */
  private isInitialAddressRead = false;

  constructor(
    private readonly session: Session,
    /** The name of the robot's file with which the page starts if the address names none. */
    private readonly defaultFile: string,
  ) {
    session.followRobot(() => this.scheduleUpdate());
  }

  /** Starts to update the address after each change of the robot; called once the initial address has been read. */
  start(): void {
    this.isInitialAddressRead = true;
    this.scheduleUpdate();
  }

  /** Schedules an update of the address. */
  scheduleUpdate(): void {
    if (!this.isInitialAddressRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // In a browser that cannot compress, the address stays as it is; the button that copies a link shows the reason.
      this.update().catch((error: unknown) => console.info(`The address does not follow the robot: ${String(error)}`));
    }, UPDATE_DELAY_MS);
  }

  private async update(): Promise<void> {
    const { toml, original, file } = this.session;
    const robot = toml === original ? null : await pack(toml);
    // The robot has changed meanwhile, so a later update is scheduled.
    if (this.session.toml !== toml) return;
    const parts = new URLSearchParams();
    const room = addressParts(location.hash).get('room');
    if (room) parts.set('room', room);
    if (robot) parts.set('robot', robot);
    else if (file !== '' && file !== this.defaultFile) parts.set('file', file);
    const pageAddress = location.href.split('#')[0] ?? '';
    history.replaceState(PAGE_ENTRY, '', parts.size > 0 ? `${pageAddress}#${parts}` : pageAddress);
  }
}
