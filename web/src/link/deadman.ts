// A robot that loses its link would continue to walk. Therefore the page sets `deadman` while a user drives: the time
// without a line after which the robot ends a gait by itself. After the gait, the page restores the robot's own
// setting.
import { WORDS } from '../words';
import type { Dialogue } from './dialogue';

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
  /** Resolves to true if the robot confirms the page's setting; null while the robot's own setting is in effect. */
  private confirmation: Promise<boolean> | null = null;
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
    if (this.robotSettingMs === null) await this.readSetting();
    // Meanwhile the robot has restarted, or a user's line needs the robot's own setting. A later call may be pending.
    if (endCount !== this.endCount) return this.confirmation ?? false;
    const ms = this.robotSettingMs ? Math.min(this.robotSettingMs, DRIVING_DEADMAN_MS) : DRIVING_DEADMAN_MS;
    const line = `${WORDS.deadman} ${ms}`;
    const isConfirmed = (await this.askQuietly(line))?.ok ?? false;
    if (endCount !== this.endCount) return this.confirmation ?? false;
    if (isConfirmed) this.dialogue.keepAlive(line, Math.floor(ms / LINES_PER_DEADMAN));
    else this.restore();
    return isConfirmed;
  }

  private async readSetting(): Promise<void> {
    const notes = (await this.askQuietly(WORDS.cal))?.notes ?? [];
    const [, ms] = notes.map((line) => /^# deadman (\d+)$/.exec(line)).find(Boolean) ?? [];
    if (ms !== undefined) this.robotSettingMs = Number(ms) === DRIVING_DEADMAN_MS ? 0 : Number(ms);
  }

  /**
   * Restores the robot's own setting before a user's line that prints, stores or replaces it. Returns true if the
   * page's setting was in effect; it must be set again after the line while the robot walks.
   */
  prepareForUserLine(line: string): boolean {
    const isReplaced = line === WORDS.load || line === WORDS.factory;
    const isRestored = this.isEngaged && (isReplaced || line === WORDS.cal || line === WORDS.save);
    if (isRestored) this.restore();
    if (isReplaced) this.robotSettingMs = null;
    return isRestored;
  }

  /** Records a change of the robot's own setting by a user's line, if the robot accepted the line. */
  observeUserLine(line: string, isAccepted: boolean): void {
    const [word, ms] = line.split(/\s+/);
    if (isAccepted && word === WORDS.deadman) this.robotSettingMs = Number(ms);
  }

  /** Stops repeating the line; the robot then stops by itself unless another sender keeps it walking. */
  stopRepeating(): void {
    this.dialogue.keepAlive(null);
  }

  /** Restores the robot's own setting. */
  restore(): void {
    this.stopRepeating();
    if (!this.isEngaged) return;
    this.confirmation = null;
    this.endCount += 1;
    if (this.robotSettingMs !== null) void this.askQuietly(`${WORDS.deadman} ${this.robotSettingMs}`);
  }

  /** Resets this object's state after a restart of the robot; sends no line. */
  reset(): void {
    this.stopRepeating();
    this.confirmation = null;
    this.endCount += 1;
    this.robotSettingMs = null;
  }

  private askQuietly(line: string) {
    return this.dialogue.ask(line, true).catch(() => null);
  }
}
