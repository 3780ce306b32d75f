// The part of the page's address after the #, which no server sees, names a room and a robot. So a link or a bookmark
// keeps a robot.
import { pack } from './link-text';
import type { Session } from './session';

/**
 * Time without a further change after which the address is written, ms: browsers refuse an address that changes too
 * often.
 */
const UPDATE_DELAY_MS = 300;

/** Returns the parts after the # of an address: `room`, and a robot as `file` or as `robot`, its compressed text. */
export const addressParts = (hash: string) => new URLSearchParams(hash.slice(1));

/**
 * The `state` of the browser history's entries that the page wrote; such an entry names a room and the robot of that
 * time.
 */
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

  /** Starts to update the address with each change of the robot; called once the page's first address has been read. */
  begin(): void {
    this.isInitialAddressRead = true;
    this.scheduleUpdate();
  }

  /** Schedules an update of the address for a changed robot. */
  scheduleUpdate(): void {
    if (!this.isInitialAddressRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // A browser that cannot compress keeps the old address; the button for a link says why.
      this.update().catch((error: unknown) => console.info(`The address does not follow the robot: ${String(error)}`));
    }, UPDATE_DELAY_MS);
  }

  private async update(): Promise<void> {
    const { toml, original, file } = this.session;
    const robot = toml === original ? null : await pack(toml);
    // The robot may have changed meanwhile; a later call then shows it.
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
