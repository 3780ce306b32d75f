// A robot out of reach would walk on. So while a user drives it, `deadman` is set, and the robot ends a gait by itself
// when no line has come for that long. After the gait its own setting is restored.
import { WORDS } from '../words';
import type { Dialogue } from './dialogue';

/** `deadman` while a user drives, ms. Users choose round numbers, so a robot with this one got it from a page that was closed. */
const DRIVEN = 901;
/** Lines that the page sends within that time: two of three may be lost. */
const LINES = 3;

export class Deadman {
  /** The robot's own setting, ms; null until it is read. */
  private own: number | null = null;
  /** The result of setting it, true once the robot has confirmed it; null while the robot has its own setting. */
  private set: Promise<boolean> | null = null;

  constructor(private readonly dialogue: Dialogue) {}

  get isSet(): boolean {
    return this.set !== null;
  }

  /** Sets `deadman` before a gait; false if the robot does not confirm it, and then no gait may start. */
  begin(): Promise<boolean> {
    return (this.set ??= this.confirmed());
  }

  private async confirmed(): Promise<boolean> {
    if (this.own === null) await this.read();
    const ms = this.own ? Math.min(this.own, DRIVEN) : DRIVEN;
    const line = `${WORDS.deadman} ${ms}`;
    const isSet = (await this.quietly(line))?.ok ?? false;
    if (isSet && this.isSet) this.dialogue.keepAlive(line, Math.floor(ms / LINES));
    return isSet;
  }

  private async read(): Promise<void> {
    const notes = (await this.quietly(WORDS.cal))?.notes ?? [];
    const [, ms] = notes.map((line) => /^# deadman (\d+)$/.exec(line)).find(Boolean) ?? [];
    if (ms !== undefined) this.own = Number(ms) === DRIVEN ? 0 : Number(ms);
  }

  /** Notes a line of the user that changes the setting. */
  follow(line: string, isOk: boolean): void {
    if (!isOk) return;
    const [word, ms] = line.split(/\s+/);
    if (word === WORDS.deadman) this.own = Number(ms);
    if (word === WORDS.load || word === WORDS.factory) this.own = null;
  }

  /** Stops sending lines, so that the robot stops unless somebody else sends some. */
  letGo(): void {
    this.dialogue.keepAlive(null);
  }

  /** Restores the robot's own setting. */
  end(): void {
    this.letGo();
    if (!this.isSet) return;
    this.set = null;
    if (this.own !== null) void this.quietly(`${WORDS.deadman} ${this.own}`);
  }

  /** Resets this state after a restart of the robot. */
  forget(): void {
    this.letGo();
    this.set = null;
    this.own = null;
  }

  private quietly(line: string) {
    return this.dialogue.ask(line, true).catch(() => null);
  }
}
