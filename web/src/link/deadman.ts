// A robot that loses its link would continue to walk. Therefore the page sets `deadman` while a user drives: the time
// without a line after which the robot ends a gait by itself. After the gait, the page restores the robot's own
// setting.
import { WORDS } from '../words';
import { type Answer, type Dialogue, DroppedRequest } from './dialogue';

/**
 * `deadman` while a user drives, ms. No user would choose this odd number; a robot with this setting got it from a page
 * that was closed.
 */
const DRIVING_DEADMAN_MS = 901;
/** Number of lines that the page sends per `deadman` time: two of three lines may be lost. */
const LINES_PER_DEADMAN = 3;

export class Deadman {
  /** The robot's own setting, ms; null until the page has read it. */
  private robotSettingMs: number | null = null;
  /** True while the robot has, or may have, the page's setting; its own setting is then known. */
  private isOverridden = false;
  /** Resolves to true if the robot confirms the page's setting; null while the page does not request that. */
  private confirmation: Promise<boolean> | null = null;
  /** Resolves to true if the robot confirms its own setting; null while the page does not request that. */
  private restoration: Promise<boolean> | null = null;
  /** Settles when the last line that needs the robot's own setting is sent or given up. */
  private userLine: Promise<boolean> | null = null;
  /** Number of times that the page's setting has ended; a call of `setAndConfirm` is outdated when it changes. */
  private endCount = 0;

  constructor(private readonly dialogue: Dialogue) {}

  /** True while the robot has, or will soon have, the page's setting. */
  get isEngaged(): boolean {
    return this.confirmation !== null;
  }

  /** Sets `deadman` before a gait. Resolves to false if the robot does not confirm it; no gait may start then. */
  engage(): Promise<boolean> {
    return (this.confirmation ??= this.setAndConfirm());
  }

  private async setAndConfirm(): Promise<boolean> {
    const { endCount } = this;
    await this.userLine;
    await this.restoration;
    if (endCount !== this.endCount) return this.confirmation ?? false;
    if (this.robotSettingMs === null) await this.readSetting();
    // Meanwhile the robot has restarted, or a user's line needs the robot's own setting. A later call may be pending.
    if (endCount !== this.endCount) return this.confirmation ?? false;
    // A setting that the page does not know could not be restored.
    const isConfirmed = this.robotSettingMs !== null && (await this.setAndRepeat(this.robotSettingMs));
    if (endCount !== this.endCount) return this.confirmation ?? false;
    if (!isConfirmed) this.confirmation = null;
    return isConfirmed;
  }

  private async setAndRepeat(robotSettingMs: number): Promise<boolean> {
    const { endCount } = this;
    const ms = Math.min(robotSettingMs || DRIVING_DEADMAN_MS, DRIVING_DEADMAN_MS);
    const line = `${WORDS.deadman} ${ms}`;
    this.isOverridden = true;
    const isConfirmed = await this.askQuietly(line);
    if (isConfirmed && endCount === this.endCount) this.dialogue.keepAlive(line, Math.floor(ms / LINES_PER_DEADMAN));
    return isConfirmed;
  }

  /** Reads the robot's own setting; returns false if the robot refuses the line that prints it. */
  private async readSetting(): Promise<boolean> {
    const answer = await this.dialogue.ask(WORDS.cal, true).catch(() => null);
    const [, text] = answer?.notes.map((line) => /^# deadman (\d+)$/.exec(line)).find(Boolean) ?? [];
    if (text === undefined) return answer?.ok !== false;
    const ms = Number(text);
    this.isOverridden ||= ms === DRIVING_DEADMAN_MS;
    this.robotSettingMs = ms === DRIVING_DEADMAN_MS ? 0 : ms;
    return true;
  }

  /** Returns true for a user's line that prints, stores or replaces the robot's own setting. */
  static needsRobotSetting(line: string): boolean {
    return [WORDS.cal, WORDS.save, WORDS.load, WORDS.factory].some((word) => word === line);
  }

  /**
   * Sends a user's line that needs the robot's own setting, by `send`, once the robot has confirmed this setting.
   * Throws an error if the robot does not confirm it. The page's setting waits until then, and must be set again while
   * the robot walks.
   */
  sendWithRobotSetting(line: string, send: () => Promise<Answer>): Promise<Answer> {
    this.end();
    const isReady = this.readAndRestore();
    this.userLine = isReady;
    return isReady.then((isRestored) => {
      if (this.dialogue.isClosed) throw new DroppedRequest();
      if (!isRestored) throw new Error(`"${line}" was not sent, because the robot did not confirm its own deadman setting`);
      if (line === WORDS.load || line === WORDS.factory) this.robotSettingMs = null;
      return send();
    });
  }

  private async readAndRestore(): Promise<boolean> {
    // A page that was closed may have left its setting behind.
    const isRefused = this.robotSettingMs === null && !(await this.readSetting());
    // A board without a robot in its flash also refuses the user's line, and reports the reason.
    if (isRefused) return true;
    return this.robotSettingMs !== null && this.sendRobotSetting();
  }

  /**
   * Records a change of the robot's own setting by a user's line; `isAccepted` is null if the answer was lost. The
   * robot may then have either value, which is read again, unless the page's setting is in effect.
   */
  observeUserLine(line: string, isAccepted: boolean | null): void {
    const [word, ms] = line.split(/\s+/);
    if (word !== WORDS.deadman) return;
    if (isAccepted) this.robotSettingMs = Number(ms);
    else if (isAccepted === null && !this.isOverridden) this.robotSettingMs = null;
  }

  /** Stops repeating the line; the robot then stops by itself unless another sender keeps it walking. */
  stopRepeating(): void {
    this.dialogue.keepAlive(null);
  }

  /** Restores the robot's own setting; resolves to false if the robot does not confirm it. A later call repeats it. */
  restore(): Promise<boolean> {
    this.end();
    return this.sendRobotSetting();
  }

  /** Ends the page's setting, without a line to the robot. */
  private end(): void {
    this.stopRepeating();
    if (!this.isEngaged) return;
    this.confirmation = null;
    this.endCount += 1;
  }

  private sendRobotSetting(): Promise<boolean> {
    if (!this.isOverridden) return Promise.resolve(true);
    if (this.restoration) return this.restoration;
    const restoration = this.askQuietly(`${WORDS.deadman} ${this.robotSettingMs}`).then((isConfirmed) => {
      // The robot has restarted meanwhile.
      if (this.restoration !== restoration) return false;
      this.restoration = null;
      this.isOverridden = !isConfirmed;
      return isConfirmed;
    });
    return (this.restoration = restoration);
  }

  /**
   * Handles a restart whose banner was lost; sends no line. A repeated line may have set the page's setting in the
   * restarted robot, so a known setting of its own is restored later.
   */
  handleUnseenRestart(): void {
    this.end();
    if (!this.isOverridden) this.robotSettingMs = null;
  }

  /** Resets this object's state after a restart of the robot; sends no line. */
  reset(): void {
    this.end();
    this.endCount += 1;
    this.restoration = null;
    this.isOverridden = false;
    this.robotSettingMs = null;
  }

  /** Sends a line that is not shown; resolves to true if the robot accepts it. */
  private askQuietly(line: string): Promise<boolean> {
    return this.dialogue.ask(line, true).then(({ ok }) => ok, () => false);
  }
}
