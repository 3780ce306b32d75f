// The fragment of the page's address, the part after the #, names a room and a robot, so that a link or a bookmark
// keeps both. The browser does not send the fragment to a server.
import { pack } from './share-link';
import type { Session } from './session';

/** Delay between a change of the robot and the update of the address, ms: browsers limit the rate of updates. */
const UPDATE_DELAY_MS = 300;

/** Parses the fragment of an address: `room`, and the robot as `file` (a file's name) or `robot` (a packed text). */
export const parseFragment = (hash: string) => new URLSearchParams(hash.slice(1));

/** The `state` of the browser history entries that the page itself wrote. */
export const PAGE_ENTRY_STATE = 'own';

export class Address {
  private timer = 0;
  /** True once the page has read its initial address. */
  private isInitialAddressRead = false;

  constructor(
    private readonly session: Session,
    /** The name of the robot file that the page loads if the address names no robot. */
    private readonly defaultFile: string,
  ) {
    session.robot.follow(() => this.scheduleUpdate());
  }

  /** Starts updating the address after each change of the robot; called once the initial address is read. */
  start(): void {
    this.isInitialAddressRead = true;
    this.scheduleUpdate();
  }

  scheduleUpdate(): void {
    if (!this.isInitialAddressRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.update(), UPDATE_DELAY_MS);
  }

  private async update(): Promise<void> {
    const { toml, original, file } = this.session.robot;
    // A robot that cannot be packed, for example because it is too long, is not in the address.
    const robot = toml === original ? null : await pack(toml).catch(() => null);
    // If the robot has changed meanwhile, another update is scheduled.
    if (this.session.robot.toml !== toml) return;
    const parameters = new URLSearchParams();
    const room = parseFragment(location.hash).get('room');
    if (room) parameters.set('room', room);
    if (robot) parameters.set('robot', robot);
    else if (file !== '' && file !== this.defaultFile) parameters.set('file', file);
    const pageAddress = location.href.split('#')[0] ?? '';
    history.replaceState(PAGE_ENTRY_STATE, '', parameters.size > 0 ? `${pageAddress}#${parameters}` : pageAddress);
  }
}
