// The page's address names a room and a robot after the #, which no server sees. So a link or a bookmark keeps
// a robot.
import { pack } from './link-text';
import type { Session } from './session';

/**
 * Time without a further change after which the address is written, ms: browsers refuse an address that changes too
 * often.
 */
const QUIET_MS = 300;

/** Returns the parts after the # of an address: `room`, and a robot as `file` or as `robot`, its compressed text. */
export const partsOf = (hash: string) => new URLSearchParams(hash.slice(1));

/**
 * The `state` of the browser history's entries that the page wrote; such an entry names a room and the robot of that
 * time.
 */
export const OWN = 'own';

export class Address {
  private timer = 0;
  /** True once the address that the page was opened with has been read. */
  private isRead = false;

  constructor(
    private readonly session: () => Session,
    /** The name of the robot's file with which the page starts if the address names none. */
    private readonly first: string,
  ) {}

  /** Starts to update the address with each change of the robot; called once the first address has been read. */
  begin(): void {
    this.isRead = true;
    this.follow();
  }

  /** Schedules an update of the address for a changed robot. */
  follow(): void {
    if (!this.isRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // A browser that cannot compress keeps the old address; the button for a link says why.
      this.show().catch((error: unknown) => console.info(`The address does not follow the robot: ${String(error)}`));
    }, QUIET_MS);
  }

  private async show(): Promise<void> {
    const { toml, original, file } = this.session();
    const robot = toml === original ? null : await pack(toml);
    // The robot may have changed meanwhile; a later call then shows it.
    if (this.session().toml !== toml) return;
    const parts = new URLSearchParams();
    const room = partsOf(location.hash).get('room');
    if (room) parts.set('room', room);
    if (robot) parts.set('robot', robot);
    else if (file !== '' && file !== this.first) parts.set('file', file);
    const pageAddress = location.href.split('#')[0] ?? '';
    history.replaceState(OWN, '', parts.size > 0 ? `${pageAddress}#${parts}` : pageAddress);
  }
}
