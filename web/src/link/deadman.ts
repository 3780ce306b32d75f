// A robot that loses its link would walk on. So while a user drives it, the page sets `deadman`, the time without a
// line after which the robot ends a gait by itself. After the gait, the robot's own setting is restored.
import { WORDS } from '../words';
import type { Dialogue } from './dialogue';

/**
 * `deadman` while a user drives, ms. No user would choose this odd number, so a robot that has it got it from a page
 * that was closed.
 */
const DRIVING_DEADMAN_MS = 901;
/** Number of lines that the page sends per `deadman` time: two of three may be lost. */
const LINES_PER_DEADMAN = 3;

export class Deadman {
  /** The robot's own setting, ms; null until it is read. */
  private robotSettingMs: number | null = null;
  /** Resolves to true if the robot confirms the page's setting; null while the robot has its own setting. */
  private confirmation: Promise<boolean> | null = null;

  constructor(private readonly dialogue: Dialogue) {}

  /** True while the robot has, or is about to get, the page's setting. */
  get isSet(): boolean {
    return this.confirmation !== null;
  }

  /** Sets `deadman` before a gait; resolves to false if the robot does not confirm it: no gait may start then. */
  engage(): Promise<boolean> {
    return (this.confirmation ??= this.setAndConfirm());
  }

  private async setAndConfirm(): Promise<boolean> {
    if (this.robotSettingMs === null) await this.readSetting();
    const ms = this.robotSettingMs ? Math.min(this.robotSettingMs, DRIVING_DEADMAN_MS) : DRIVING_DEADMAN_MS;
    const line = `${WORDS.deadman} ${ms}`;
    const isSet = (await this.askQuietly(line))?.ok ?? false;
    if (isSet && this.isSet) this.dialogue.keepAlive(line, Math.floor(ms / LINES_PER_DEADMAN));
    return isSet;
  }

  private async readSetting(): Promise<void> {
    const notes = (await this.askQuietly(WORDS.cal))?.notes ?? [];
    const [, ms] = notes.map((line) => /^# deadman (\d+)$/.exec(line)).find(Boolean) ?? [];
    if (ms !== undefined) this.robotSettingMs = Number(ms) === DRIVING_DEADMAN_MS ? 0 : Number(ms);
  }

  /** Notes the change of the robot's own setting by a user's line, if the robot has accepted the line. */
  noteLine(line: string, isAccepted: boolean): void {
    if (!isAccepted) return;
    const [word, ms] = line.split(/\s+/);
    if (word === WORDS.deadman) this.robotSettingMs = Number(ms);
    if (word === WORDS.load || word === WORDS.factory) this.robotSettingMs = null;
  }

  /** Stops repeating the line, so that the robot stops by itself unless another sender keeps it walking. */
  stopRepeating(): void {
    this.dialogue.keepAlive(null);
  }

  /** Restores the robot's own setting. */
  restore(): void {
    this.stopRepeating();
    if (!this.isSet) return;
    this.confirmation = null;
    if (this.robotSettingMs !== null) void this.askQuietly(`${WORDS.deadman} ${this.robotSettingMs}`);
  }

  /** Resets this object's state after a restart of the robot; sends nothing. */
  reset(): void {
    this.stopRepeating();
    this.confirmation = null;
    this.robotSettingMs = null;
  }

  private askQuietly(line: string) {
    return this.dialogue.ask(line, true).catch(() => null);
  }
}
