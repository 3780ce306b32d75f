// The page's address holds its robot, behind the # where no server sees it: a link is a robot, and so is a bookmark.
import { linkTo } from './link-text';
import type { Session } from './session';

const FILE = '#file=';
/** Changes that follow on each other are one, ms: browsers refuse an address that changes too often. */
const QUIET = 300;

/** The name of the file that an address asks for; null where it asks for none. */
export function fileIn(hash: string): string | null {
  return hash.startsWith(FILE) ? decodeURIComponent(hash.slice(FILE.length)) : null;
}

export class Address {
  private timer = 0;
  /** Whether what the page was opened with has been read. */
  private isRead = false;

  constructor(
    private readonly session: () => Session,
    /** The file that the page begins with when nothing is asked for. */
    private readonly first: string,
  ) {}

  /** What the page was opened with has been read: from now on its address follows the robot. */
  begin(): void {
    this.isRead = true;
    this.follow();
  }

  /** The robot is another one. */
  follow(): void {
    if (!this.isRead) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // A browser that cannot compress has the address of before; the button for a link says why.
      this.show().catch((error: unknown) => console.info(`The address does not follow the robot: ${String(error)}`));
    }, QUIET);
  }

  private async show(): Promise<void> {
    const { toml, original, file } = this.session();
    const plain = location.href.split('#')[0] ?? location.href;
    const own = file === '' || file === this.first ? plain : `${plain}${FILE}${encodeURIComponent(file)}`;
    const address = toml === original ? own : await linkTo(toml);
    // It may have changed meanwhile, and then it is shown later.
    if (this.session().toml === toml && address !== location.href) history.replaceState(null, '', address);
  }
}
