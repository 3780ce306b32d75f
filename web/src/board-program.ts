// The program in a board's flash, which consists of the firmware and a robot: the page identifies and replaces it.
import type { Board, BoardListener } from './board';
import { loadBoardModule } from './board-module';
import type { BootLoaderLine } from './link/boot-loader-line';
import { GONE_MESSAGE, type Link } from './link/link';
import { getMessage } from './problem';
import type { Banner } from './robot';
import type { BoardBanner, SessionState } from './session-state';
import type { ShownRobot } from './shown-robot';
import { WORDS } from './words';

/** Longest wait for the answer of a board that was not reset, ms. */
const PROBE_TIMEOUT_MS = 500;
/**
 * Number of `status` lines sent to a board that was not reset: the board needs up to five lines to find the baud rate,
 * and a radio may lose some.
 */
const MAX_PROBE_COUNTS = { usb: 5, radio: 12, simulated: 1 };

/** The reason why a board cannot be written by radio. */
export const NO_WRITING_BY_RADIO = 'a radio cannot reset the board and is too slow; connect the board by its USB cable to write to it';

/** Called with the progress of a write: `done` of the `total` pages of a step are finished. */
export type ReportProgress = (step: 'reading' | 'writing' | 'verifying' | 'retrying', done: number, total: number) => void;

/** Callbacks for questions and problems about a board's program. */
export interface ProgramListener extends Pick<BoardListener, 'onProblem'> {
  /** Asks the user to confirm that the board is a UNO: on a Nano, writing would overwrite the boot loader. */
  confirmUno(): boolean;
}

const isBanner = (banner: BoardBanner | undefined): banner is Banner => typeof banner === 'object' && banner !== null;

export class BoardProgram {
  /** True if a board without this firmware has a UNO's boot loader. */
  hasBootLoader = false;

  constructor(
    private readonly state: SessionState,
    private readonly robot: ShownRobot,
    private readonly board: Board,
    private readonly listener: ProgramListener,
  ) {}

  get isFirmwareAnswering(): boolean {
    const { banner } = this.board;
    return banner !== undefined && banner !== null;
  }

  /** True if the board's robot equals the page's robot. */
  get hasThisRobot(): boolean {
    const { banner } = this.board;
    return isBanner(banner) && banner.robot?.hash === this.robot.description.hash;
  }

  /** The board's robot according to its banner; null if it is unknown or equals the page's robot. */
  get otherRobot(): { name: string; hash: string } | null {
    const { banner } = this.board;
    return isBanner(banner) && !this.hasThisRobot ? banner.robot : null;
  }

  /**
   * Identifies the program of a board that was just connected, or to which a write has failed. Returns true if the
   * board is connected at the end, and false if the user disconnects it or writes to it meanwhile.
   */
  async identify(): Promise<boolean> {
    const { board } = this;
    const { link, dialogue } = board;
    // Opening a USB port resets the board. The boot loader would receive bytes that are sent before the banner.
    const isRadio = link.kind === 'radio';
    const hasSentBanner = !isRadio && (await board.waitForBanner());
    for (let n = 0; !hasSentBanner && !dialogue.isClosed && board.banner === undefined && n < MAX_PROBE_COUNTS[link.kind]; n++) {
      const answer = await dialogue.ask(WORDS.status, true, PROBE_TIMEOUT_MS).catch(() => null);
      if (answer?.ok) this.state.banner.value = 'unknown';
    }
    // The board is gone, or its boot loader already uses the line.
    if (dialogue.isClosed) return false;
    if (board.banner) await board.watch();
    else if (isRadio) this.reportUnknown(`The module is connected, but no robot answers from the ${link.name}. Check that the module's TXD is on D0, and that the robot is switched on.`, false);
    else await this.identifyBootLoader(link);
    return board.link === link && !board.dialogue.isClosed;
  }

  /** Identifies a board without this firmware by its boot loader. */
  private async identifyBootLoader(link: Link): Promise<void> {
    let message: string;
    let hasBootLoader = false;
    try {
      const model = await this.withBootLoader(link, async ({ identify }, line) => identify(line));
      message = `The board is an Arduino ${model}, an ATmega328P according to its boot loader, without this firmware.`;
      hasBootLoader = true;
    } catch (error) {
      message = `The board does not answer like this firmware: ${getMessage(error)}.`;
    }
    const { board } = this;
    // A write may have begun first, and a started program of this firmware may already have sent its banner.
    if (board.link === link && !board.dialogue.isClosed && board.banner === undefined) this.reportUnknown(message, hasBootLoader);
  }

  /** Reports a board on which this firmware does not answer. */
  private reportUnknown(message: string, hasBootLoader: boolean): void {
    this.hasBootLoader = hasBootLoader;
    this.state.banner.value = null;
    this.listener.onProblem('board', message);
  }

  /**
   * Writes firmware and robot, or only the robot after the board's firmware, and starts the board. Throws an error
   * whose message tells the user the board's content.
   */
  async write(bytes: Uint8Array, isRobotAlone: boolean, reportProgress: ReportProgress): Promise<void> {
    const { link } = this.board;
    if (link.kind === 'radio') throw new Error(NO_WRITING_BY_RADIO);
    const endAddress = bytes.length + (isRobotAlone ? this.robot.description.start : 0);
    await this.withBootLoader(link, async ({ Board, needsUno, upload }, line) => {
      const board = !link.mayBeNano || !needsUno(endAddress) ? Board.Unknown : this.listener.confirmUno() ? Board.Uno : Board.Nano;
      this.board.forgetProgram();
      await upload(line, bytes, isRobotAlone, board, reportProgress);
    }).catch((error: unknown) => {
      const { banner, dialogue } = this.board;
      // A real board may still run its previous program. A simulated board has nothing to identify.
      if (this.board.isReal && this.board.link === link && !dialogue.isClosed && banner === undefined) void this.identify();
      throw error;
    });
  }

  /** Loads the module for boards, and runs `action` with it while the boot loader uses the line. */
  private async withBootLoader<T>(link: Link, action: (module: Awaited<ReturnType<typeof loadBoardModule>>, line: BootLoaderLine) => Promise<T>): Promise<T> {
    const module = await loadBoardModule();
    // The board may be gone meanwhile.
    if (this.board.link !== link) throw new Error(GONE_MESSAGE);
    return this.board.lendLine((line) => action(module, line));
  }

  /**
   * Waits for the banner of a board that was just written, and compares the robot's hash with `hash` unless `hash` is
   * null. Returns the problem as the end of a sentence; null if there is none.
   */
  async checkWritten(hash: string | null): Promise<string | null> {
    const { board } = this;
    const { link, dialogue } = board;
    // The banner may have arrived right after the boot loader's last answer.
    const hasSentBanner = board.banner !== undefined || (await board.waitForBanner());
    // The board is gone, or another write has begun.
    if (board.link !== link || dialogue.isClosed) return null;
    if (!hasSentBanner) {
      this.reportUnknown(`The ${link.name} sends no banner: the written program is not this firmware.`, true);
      return 'the board sends no banner of this firmware';
    }
    const boardHash = isBanner(board.banner) ? board.banner.robot?.hash : null;
    return hash !== null && boardHash !== hash ? 'the board does not report this robot: write firmware and robot' : null;
  }
}
