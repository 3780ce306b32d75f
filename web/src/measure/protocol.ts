// Drives gaits one after another in front of a camera, keeps the robot near the sheet of tags, and records the time
// of each walk. Any other activity of the robot ends the protocol: `stop`, another gait, a lost link.
import { DONE, GAITS, WORDS } from '../words';
import type { Back } from './seen';

/**
 * Limits of a return by a gait: most cycles, most attempts, and the least share of the distance that must lie ahead
 * or behind.
 */
const RETURN = { cycles: 12, tries: 2, minAhead: 0.7 };
/** Least distance per cycle of a gait by which the robot can return, mm, and its largest turn, deg. */
const RETURN_GAIT = { way: 3, turn: 2 };
/**
 * Distance from the middle of the sheet beyond which the robot returns first if the next walk would leave the sheet,
 * mm.
 */
const RETURN_DISTANCE_MM = 80;
/**
 * Outward movement near the edge of the sheet that ends a walk, mm; not less, since the body swings within each
 * cycle.
 */
const MAX_OUTWARD_MM = 20;
/** Time for which the robot may walk without being seen by the camera, s. */
const MAX_UNSEEN_S = 2;
/**
 * Least cycles of a walk: its first and last cycle are not measured. A walk that was cut shorter counts as this many.
 */
export const MIN_CYCLES = 4;

/** A gait that the robot walked, on the film's clock. */
export interface Walk {
  gait: string;
  /** Begin and end, s. */
  during: [number, number];
}

/** The predicted displacement per cycle of a gait: mm and deg. */
export interface PredictedCycle {
  command: string;
  forward: number;
  turn: number;
}

export interface Plan {
  /** The gaits, each with the time of a cycle at full speed, s. */
  gaits: { command: string; period: number }[];
  /**
   * Number of cycles of each gait. Cycles that the edge of the sheet cuts off are walked once the robot is back in
   * the middle.
   */
  cycles: number;
  /** Pace, percent. */
  speed: number;
  /** Time from one walk to the next, s. */
  pause: number;
}

/** The robot and the camera, as the protocol uses them. */
export interface Stage {
  /** Sends a line; resolves to true if the robot accepts it. */
  ask: (line: string) => Promise<boolean>;
  /** The film's clock, s. */
  now: () => number;
  /** Waits some seconds. */
  wait: (seconds: number) => Promise<void>;
  /** Returns the predicted displacements of the gaits, as far as they are known. */
  ways: () => PredictedCycle[];
  /** Asks a person to put the robot back; resolves when that is done, or when the protocol is over. */
  putBack: () => Promise<void>;
  say: (text: string) => void;
}

/** Thrown when the protocol has ended before its last walk. */
export class Interrupted extends Error {}

/** A walk that has not ended yet. */
interface Waiting {
  gait: string;
  /** The robot's least distance from the middle so far, mm; null until the robot has accepted the gait. */
  nearest: number | null;
  /** True if the walk is being ended before its last cycle. */
  isCut: boolean;
  /** The end of the walk on the film's clock, s; null until it has ended. */
  end: number | null;
  done: () => void;
  fail: (error: Error) => void;
}

const distance = ({ ahead, aside }: Back) => Math.hypot(ahead, aside);

export class Protocol {
  readonly walks: Walk[] = [];
  private waiting: Waiting | null = null;
  /** The last line that the protocol has sent. */
  private lastSent = '';
  /** Called when the protocol is over. */
  onEnd: () => void = () => {};
  /** The reason why the protocol is over; null until then. */
  private endReason: Interrupted | null = null;
  /** The robot's last known place, and its time on the film's clock, s; null before the first. */
  private last: { back: Back; seconds: number } | null = null;

  constructor(private readonly stage: Stage) {}

  /** Walks all gaits. Throws {@link Interrupted}; the walks so far are kept. */
  async run({ gaits, cycles, speed, pause }: Plan): Promise<void> {
    const { stage } = this;
    await this.ask(`${WORDS.speed} ${speed}`);
    for (const [i, { command, period }] of gaits.entries()) {
      const { forward = 0 } = stage.ways().find((predicted) => predicted.command === command) ?? {};
      for (let cyclesLeft = cycles; cyclesLeft >= MIN_CYCLES; ) {
        await this.goBack(cyclesLeft * forward);
        await this.wait(pause);
        stage.say(`${i + 1} of ${gaits.length}: ${command}, ${cyclesLeft} cycles`);
        const [begin, end] = await this.walk(command, cyclesLeft, (during) => this.walks.push({ gait: command, during }));
        cyclesLeft -= Math.max(MIN_CYCLES, Math.floor(((end - begin) * speed) / 100 / period));
      }
    }
    await this.wait(pause);
  }

  /**
   * Takes the robot's place in a picture, null if the picture does not show it. Ends a walk that leaves the sheet.
   */
  setPlace(back: Back | null): void {
    if (!back) return;
    this.last = { back, seconds: this.stage.now() };
    const { waiting } = this;
    if (waiting === null || waiting.nearest === null) return;
    waiting.nearest = Math.min(waiting.nearest, distance(back));
    if (back.isNear && distance(back) > waiting.nearest + MAX_OUTWARD_MM) this.cut(waiting);
  }

  /** Takes a line that was sent to the robot, by the protocol or another part of the page. */
  sent(line: string): void {
    const isWalk = ({ command }: PredictedCycle) => line === command || line.startsWith(`${command} `);
    if (line === WORDS.stop) this.end('it was stopped');
    else if (line !== this.lastSent && this.stage.ways().some(isWalk)) this.end(`the robot was sent "${line}"`);
  }

  /** Takes a line that the robot printed: `DONE` ends a walk, and arrives before `doing` is called. */
  received(line: string): void {
    if (line !== DONE || !this.waiting) return;
    this.finish(this.waiting);
    this.waiting = null;
  }

  /** Takes the robot's current activity; one that is not the protocol's ends the protocol. */
  setActivity(activity: string): void {
    const { waiting } = this;
    const isWalking = waiting?.gait === activity;
    const isStanding = activity === WORDS.stop || activity === GAITS.stand;
    if (isWalking || (isStanding && (waiting === null || waiting.isCut))) return;
    this.end(activity === '' ? 'the link to the robot was cut, or it was reset' : `the robot does "${activity}"`);
  }

  /**
   * Ends the protocol for an external reason, such as a camera that is switched off, and stops a robot that walks.
   */
  stop(reason: string): void {
    const isWalking = this.waiting !== null;
    this.end(reason);
    if (isWalking) void this.stage.ask(WORDS.stop);
  }

  /** Ends the protocol: nothing more is sent. */
  end(reason: string): void {
    this.endReason ??= new Interrupted(reason);
    if (this.waiting) this.finish(this.waiting, this.endReason);
    this.waiting = null;
    this.onEnd();
  }

  /** The robot's place; null if the camera has not seen the robot for `MAX_UNSEEN_S`. */
  private get place(): Back | null {
    return this.last && this.stage.now() - this.last.seconds < MAX_UNSEEN_S ? this.last.back : null;
  }

  /**
   * Brings the robot back if it is near the edge of the sheet: by a gait that leads to the middle, or else by hand.
   * If only the next walk, of `forwardMm` mm, would leave the sheet, the robot returns to the middle if a gait can take it
   * there.
   */
  private async goBack(forwardMm: number): Promise<void> {
    for (let n = 0; ; n++) {
      const { place, stage } = this;
      const isFit = place !== null && !place.isNear;
      const isLeaving = place !== null && n === 0 && distance(place) > RETURN_DISTANCE_MM && Math.hypot(place.ahead - forwardMm, place.aside) > place.reach;
      if (isFit && !isLeaving) return;
      const gait = place && n < RETURN.tries && Math.abs(place.ahead) > RETURN.minAhead * distance(place) ? this.gaitToward(place.ahead) : null;
      if (place && gait) {
        stage.say(`Back to the middle by ${gait.command}`);
        await this.walk(gait.command, Math.min(RETURN.cycles, Math.max(1, Math.round(place.ahead / gait.forward))));
      } else if (isFit) return;
      else await stage.putBack();
      this.check();
    }
  }

  /**
   * Returns the gait that hardly turns and walks farthest ahead, or back if `ahead` is negative; null if none is fit.
   */
  private gaitToward(ahead: number): PredictedCycle | null {
    const progressOf = ({ forward, turn }: PredictedCycle) => (Math.abs(turn) < RETURN_GAIT.turn ? forward * Math.sign(ahead) : 0);
    const [best] = this.stage.ways().sort((a, b) => progressOf(b) - progressOf(a));
    return best && progressOf(best) > RETURN_GAIT.way ? best : null;
  }

  /**
   * Walks a gait to its last cycle, or to the edge of the sheet; returns begin and end, which `record` also gets if it
   * was interrupted.
   */
  private async walk(gait: string, cycles: number, record: (during: [number, number]) => void = () => {}): Promise<[number, number]> {
    const { stage } = this;
    const waiting: Waiting = { gait, nearest: null, isCut: false, end: null, done: () => {}, fail: () => {} };
    const walkEnd = new Promise<void>((resolve, reject) => Object.assign(waiting, { done: resolve, fail: reject }));
    // The promise may reject before it is awaited.
    walkEnd.catch(() => {});
    this.waiting = waiting;
    const begin = stage.now();
    await this.ask(`${gait} ${cycles}`);
    waiting.nearest = this.place ? distance(this.place) : Infinity;
    void this.watch(waiting);
    try {
      await walkEnd;
    } finally {
      record([begin, waiting.end ?? begin]);
    }
    if (waiting.isCut) {
      await this.ask(GAITS.stand);
      this.waiting = null;
    }
    return [begin, waiting.end ?? begin];
  }

  /** Ends a walk once the robot is not seen any more. */
  private async watch(waiting: Waiting): Promise<void> {
    while (this.waiting === waiting && !waiting.isCut) {
      if (!this.place) return this.cut(waiting);
      await this.stage.wait(MAX_UNSEEN_S / 4);
    }
  }

  /** Ends a walk before its last cycle; the robot walks on until it is told to stand. */
  private cut(waiting: Waiting): void {
    waiting.isCut = true;
    this.finish(waiting);
  }

  private finish(waiting: Waiting, error?: Error): void {
    waiting.end ??= this.stage.now();
    if (error) waiting.fail(error);
    else waiting.done();
  }

  private check(): void {
    if (this.endReason) throw this.endReason;
  }

  private async wait(seconds: number): Promise<void> {
    await this.stage.wait(seconds);
    this.check();
  }

  private async ask(line: string): Promise<void> {
    this.check();
    this.lastSent = line;
    if (!(await this.stage.ask(line))) this.stop(`the robot did not take "${line}"`);
    this.check();
  }
}
