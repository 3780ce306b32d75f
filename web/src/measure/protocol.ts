// Drives gaits one after another before a camera, and keeps when the robot walked each of them. Anything else that the robot
// does meanwhile ends it: Stop, another gait, a cut link.
import { DONE } from '../session';
import { GAITS, WORDS } from '../words';

/** A gait that the robot walked, on the film's clock. */
export interface Walk {
  gait: string;
  /** Percent. */
  speed: number;
  /** Begin and end, s. */
  during: [number, number];
}

export interface Plan {
  /** Commands of the gaits. */
  gaits: string[];
  cycles: number;
  /** Percent. */
  speed: number;
  /** Time from one walk to the next, s. */
  pause: number;
}

/** The robot and the camera, as the protocol uses them. */
export interface Stage {
  /** Sends a line; resolves with true if the robot does it. */
  ask: (line: string) => Promise<boolean>;
  /** The film's clock, s. */
  now: () => number;
  /** Waits some seconds. */
  wait: (seconds: number) => Promise<void>;
  /** Has the robot turned back or put back, if it is near the end of what the camera sees; resolves when it is not. */
  inside: () => Promise<void>;
  say: (text: string) => void;
}

/** Thrown where the robot did something else than the protocol. */
export class Interrupted extends Error {}

export class Protocol {
  readonly walks: Walk[] = [];
  private waiting: { gait: string; done: () => void; fail: (error: Error) => void } | null = null;
  /** Called when it is over. */
  onEnd: () => void = () => {};
  /** The reason why it is over, or null. */
  private over: Interrupted | null = null;

  constructor(private readonly stage: Stage) {}

  /** Walks all gaits. Throws {@link Interrupted}, and then the walks before it are still there. */
  async run({ gaits, cycles, speed, pause }: Plan): Promise<void> {
    const { stage } = this;
    await this.ask(`${WORDS.speed} ${speed}`);
    for (const [i, gait] of gaits.entries()) {
      await stage.inside();
      this.check();
      await this.wait(pause);
      stage.say(`${i + 1} of ${gaits.length}: ${gait}, ${cycles} cycles`);
      const begin = stage.now();
      await this.walk(gait, cycles);
      this.walks.push({ gait, speed, during: [begin, stage.now()] });
    }
    await this.wait(pause);
  }

  /** Walks a gait to the end of its cycles. */
  async walk(gait: string, cycles: number): Promise<void> {
    const walked = new Promise<void>((done, fail) => (this.waiting = { gait, done, fail }));
    // It may be over before the answer.
    walked.catch(() => {});
    await this.ask(`${gait} ${cycles}`);
    await walked;
  }

  /** Takes a line that was sent to the robot. */
  sent(line: string): void {
    if (line === WORDS.stop) this.end('it was stopped');
  }

  /** Takes a line of the robot; the one at the end of a gait comes before its new activity. */
  received(line: string): void {
    if (line !== DONE) return;
    this.waiting?.done();
    this.waiting = null;
  }

  /** Takes the robot's present activity. */
  doing(activity: string): void {
    const mine: string[] = this.waiting ? [this.waiting.gait] : [WORDS.stop, GAITS.stand];
    if (mine.includes(activity)) return;
    this.end(activity === '' ? 'the link to the robot was cut, or it was reset' : `the robot does "${activity}"`);
  }

  /** Ends it: nothing more is sent. */
  end(why: string): void {
    this.over ??= new Interrupted(why);
    this.waiting?.fail(this.over);
    this.waiting = null;
    this.onEnd();
  }

  private check(): void {
    if (this.over) throw this.over;
  }

  private async wait(seconds: number): Promise<void> {
    await this.stage.wait(seconds);
    this.check();
  }

  private async ask(line: string): Promise<void> {
    this.check();
    if (!(await this.stage.ask(line))) this.end(`the robot did not take "${line}"`);
    this.check();
  }
}
