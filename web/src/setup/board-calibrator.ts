// The calibration of a board at its first connection. The WebAssembly module for boards implements the steps, in Rust.
import type { Console, Calibrator } from '../../generated/board';
import { loadBoardModule } from '../board-module';
import type { Answer } from '../link/dialogue';
import type { Link } from '../link/link';
import type { Calibration } from '../robot';
import type { Session } from '../session';
import { WORDS } from '../words';

/** The words of the lines that change the robot's settings. */
const SETTING_WORDS: readonly string[] = [WORDS.trim, WORDS.limit, WORDS.dir, WORDS.scale, WORDS.boot, WORDS.deadman, WORDS.load, WORDS.factory];

const LOST_MESSAGE = 'The board has restarted or is gone; unsaved settings are lost.';

/** The console of a board; usable until the board restarts or is gone. */
class BoardConsole implements Console {
  private readonly link: Link;
  private readonly bannerCount: number;
  /** The line that waits for its answer; null for none. */
  pendingLine: string | null = null;

  constructor(private readonly session: Session) {
    this.link = session.board.link;
    this.bannerCount = session.state.bannerCount.value;
  }

  /** True if the board is still connected and has not restarted. */
  get isCurrent(): boolean {
    return this.session.board.link === this.link && this.session.state.bannerCount.value === this.bannerCount;
  }

  async ask(line: string): Promise<Answer> {
    if (!this.isCurrent) throw new Error(LOST_MESSAGE);
    this.pendingLine = line;
    const answer = await this.session.board.ask(line, line === WORDS.status);
    this.pendingLine = null;
    if (answer) return answer;
    throw new Error(this.isCurrent ? `The robot did not answer "${line}".` : LOST_MESSAGE);
  }

  wait(ms: number): Promise<void> {
    return this.link.wait(ms);
  }
}

/** Calibrates the connected board step by step. */
export class BoardCalibrator {
  /** The robot's calibration after the last action, saved or not. */
  calibration: Readonly<Calibration>;
  /** True if the calibration is not saved. */
  isChanged = false;
  /** True if another part of the page may have changed the calibration; the next action reads it again first. */
  mayBeOutdated = false;
  /** True if an action noticed a restart, whose banner a radio may lose. */
  private wasReset = false;

  private constructor(
    private readonly boardConsole: BoardConsole,
    private readonly calibrator: Calibrator,
  ) {
    this.calibration = calibrator.calibration;
  }

  /** Reads the robot's calibration; nothing moves. Throws an error with a message for the user. */
  static async begin(session: Session): Promise<BoardCalibrator> {
    const boardConsole = new BoardConsole(session);
    const { Calibrator } = await loadBoardModule();
    return new BoardCalibrator(boardConsole, await Calibrator.begin(boardConsole));
  }

  /** True if the board is still connected and has not restarted. */
  get isCurrent(): boolean {
    return !this.wasReset && this.boardConsole.isCurrent;
  }

  /** Handles a line that this calibrator or another part of the page has sent to the robot. */
  handleSent(line: string): void {
    const [word = ''] = line.trim().toLowerCase().split(/\s+/);
    if (line !== this.boardConsole.pendingLine && SETTING_WORDS.includes(word)) this.mayBeOutdated = true;
  }

  /** Runs an action; only one action may run at a time. Throws an error with a message for the user. */
  async run<T>(action: (calibrator: Calibrator) => Promise<T>): Promise<T> {
    try {
      if (this.mayBeOutdated) {
        // A line that is sent meanwhile sets it again.
        this.mayBeOutdated = false;
        try {
          await this.calibrator.readAgain();
        } catch (error) {
          this.mayBeOutdated = true;
          throw error;
        }
      }
      return await action(this.calibrator);
    } finally {
      this.wasReset ||= this.calibrator.takeReset();
      // After a restart, `isChanged` tells whether settings are lost.
      if (!this.wasReset) ({ calibration: this.calibration, isChanged: this.isChanged } = this.calibrator);
    }
  }
}
