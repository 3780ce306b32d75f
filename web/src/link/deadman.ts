// A robot that is out of reach would walk on. So while a person drives it, `deadman` is set: it ends a gait by itself
// when no line has come for that long. When the gait has ended, it gets its own setting back.
import { WORDS } from '../words';
import type { Dialogue } from './dialogue';

/** `deadman` while a person drives, ms. A person sets round numbers, so this one was left by a page that was closed. */
const DRIVEN = 901;
/** Lines that the page sends within that time: two of three may be lost. */
const LINES = 3;

export class Deadman {
  /** The robot's own setting, ms; null until it is read. */
  private own: number | null = null;
  /** Present from the line that sets it until the one that takes it back; true once the robot has confirmed it. */
  private set: Promise<boolean> | null = null;

  constructor(private readonly dialogue: Dialogue) {}

  get isSet(): boolean {
    return this.set !== null;
  }

  /** Sets it, before a gait; false if the robot does not confirm it, and then nobody may start one. */
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

  /** Notes a person's own line. */
  follow(line: string, isOk: boolean): void {
    if (!isOk) return;
    const [word, ms] = line.split(/\s+/);
    if (word === WORDS.deadman) this.own = Number(ms);
    if (word === WORDS.load || word === WORDS.factory) this.own = null;
  }

  /** Sends nothing more by itself: the robot stops if nobody else does. */
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

  /** Forgets all: the robot has restarted. */
  forget(): void {
    this.letGo();
    this.set = null;
    this.own = null;
  }

  private quietly(line: string) {
    return this.dialogue.ask(line, true).catch(() => null);
  }
}
