// The page's address holds its robot, behind the # where no server sees it: a link is a robot, and so is a bookmark.
import { linkTo } from './link-text';
import type { Session } from './session';

const FILE = '#file=';
/** Changes closer together than this are written as one, ms: browsers refuse an address that changes too often. */
const QUIET = 300;

/** The file name in an address; null if it has none. */
export function fileIn(hash: string): string | null {
  return hash.startsWith(FILE) ? decodeURIComponent(hash.slice(FILE.length)) : null;
}

export class Address {
  private timer = 0;
  /** True once the address that the page was opened with has been read. */
  private isRead = false;

  constructor(
    private readonly session: () => Session,
    /** The file that the page starts with if the address names none. */
    private readonly first: string,
  ) {}

  /** Starts to update the address with each change of the robot; called once the first address has been read. */
  begin(): void {
    this.isRead = true;
    this.follow();
  }

  /** Schedules the address of a changed robot. */
  follow(): void {
    if (!this.isRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // A browser that cannot compress keeps the old address; the button for a link says why.
      this.show().catch((error: unknown) => console.info(`The address does not follow the robot: ${String(error)}`));
    }, QUIET);
  }

  private async show(): Promise<void> {
    const { toml, original, file } = this.session();
    const plain = location.href.split('#')[0] ?? location.href;
    const own = file === '' || file === this.first ? plain : `${plain}${FILE}${encodeURIComponent(file)}`;
    const address = toml === original ? own : await linkTo(toml);
    // The robot may have changed meanwhile; a later call then shows it.
    if (this.session().toml === toml && address !== location.href) history.replaceState(null, '', address);
  }
}
