// The protocol of a measurement: drives gaits one after another in front of a camera, keeps the robot near the sheet of
// tags, and records the time of each walk. Any other activity of the robot, such as `stop` or another gait, ends it; so
// does the loss of the link.
import { DONE_LINE, GAITS, WORDS } from '../words';
import type { OffsetToMiddle } from './tag-tracker';

/**
 * Limits of a return to the middle of the sheet by a gait: cycles per attempt, attempts, and the least share of the
 * distance that must lie ahead or behind.
 */
const RETURN_LIMITS = { maxCycles: 12, maxAttempts: 2, minForwardShare: 0.7 };
/** Conditions for a gait by which the robot can return: least distance and largest turn, each per cycle. */
const RETURN_GAIT = { minForwardMm: 3, maxTurnDeg: 2 };
/** Distance from the middle, mm, beyond which the robot first returns if the next walk would leave the sheet. */
const RETURN_DISTANCE_MM = 80;
/** Outward movement near the edge of the sheet that ends a walk, mm. It must exceed the body's swing within a cycle. */
const MAX_OUTWARD_MM = 20;
/** Time for which the robot may walk without being detected by the camera, s. */
const MAX_UNSEEN_S = 2;
/**
 * Least number of cycles of a walk, whose first and last cycle are not measured. A walk that was cut shorter counts as
 * this many cycles.
 */
export const MIN_CYCLES = 4;

/** A gait that the robot has walked. */
export interface Walk {
  gait: string;
  /** Start and end on the film's clock, s. */
  during: [number, number];
}

/** The predicted displacement of a gait per cycle: `forward` in mm, `turn` in deg. */
export interface PredictedCycle {
  command: string;
  forward: number;
  turn: number;
}

/** The gaits to walk, and how to walk them. */
export interface Plan {
  /** The gaits, each with the duration of a cycle at full speed, s. */
  gaits: { command: string; period: number }[];
  /**
   * Number of cycles of each gait. If the edge of the sheet cuts a walk short, the other cycles follow once the robot
   * is back in the middle.
   */
  cycles: number;
  /** Pace of all gaits, percent. */
  speed: number;
  /** Time from one walk to the next, s. */
  pause: number;
}

/** The robot, the camera and the user, as the protocol needs them. */
export interface Stage {
  /** Sends a line; resolves to true if the robot accepts it. */
  ask: (line: string) => Promise<boolean>;
  /** The film's clock, s. */
  now: () => number;
  /** Waits for `seconds`, in the robot's time. */
  wait: (seconds: number) => Promise<void>;
  /** Returns the predicted displacements of all gaits that have a prediction. */
  predictions: () => PredictedCycle[];
  /** Asks the user to put the robot back; resolves when that is done, or when the protocol is over. */
  putBack: () => Promise<void>;
  /** Shows the progress to the user. */
  showProgress: (text: string) => void;
}

/** Thrown when the protocol ends before its last walk; the message is the reason. */
export class Interrupted extends Error {}

/** A walk that has not ended yet. */
interface ActiveWalk {
  gait: string;
  /** Least distance of the robot from the middle so far, mm; null until the robot has accepted the gait. */
  nearestMm: number | null;
  /** True once the walk is ended before its last cycle. */
  isCut: boolean;
  /** The end of the walk on the film's clock, s; null until it has ended. */
  endSeconds: number | null;
  resolve: () => void;
  reject: (error: Error) => void;
}

const distance = ({ forward, left }: OffsetToMiddle) => Math.hypot(forward, left);

export class Protocol {
  /** The measured walks so far, without returns. */
  readonly walks: Walk[] = [];
  private activeWalk: ActiveWalk | null = null;
  /** The last line that the protocol has sent. */
  private lastSent = '';
  /** Called when the protocol is over. */
  onEnd: () => void = () => {};
  /** The reason why the protocol is over; null until then. */
  private endReason: Interrupted | null = null;
  /** The last detected offset, and its time on the film's clock, s; null before the first. */
  private lastSighting: { offset: OffsetToMiddle; seconds: number } | null = null;

  constructor(private readonly stage: Stage) {}

  /** Walks all gaits of a plan. Throws {@link Interrupted}; `walks` then has the walks so far. */
  async run({ gaits, cycles, speed, pause }: Plan): Promise<void> {
    const { stage } = this;
    await this.ask(`${WORDS.speed} ${speed}`);
    for (const [i, { command, period }] of gaits.entries()) {
      const { forward = 0 } = stage.predictions().find((predicted) => predicted.command === command) ?? {};
      for (let cyclesLeft = cycles; cyclesLeft >= MIN_CYCLES; ) {
        await this.goBack(cyclesLeft * forward);
        await this.wait(pause);
        stage.showProgress(`${i + 1} of ${gaits.length}: ${command}, ${cyclesLeft} cycles`);
        const [start, end] = await this.walk(command, cyclesLeft, (during) => this.walks.push({ gait: command, during }));
        cyclesLeft -= Math.max(MIN_CYCLES, Math.floor(((end - start) * speed) / 100 / period));
      }
    }
    await this.wait(pause);
  }

  /**
   * Sets the robot's offset in the latest picture; null if the picture does not show the robot. Ends a walk that leaves
   * the sheet.
   */
  setPlace(offset: OffsetToMiddle | null): void {
    if (!offset) return;
    this.lastSighting = { offset, seconds: this.stage.now() };
    const { activeWalk } = this;
    if (activeWalk === null || activeWalk.nearestMm === null) return;
    activeWalk.nearestMm = Math.min(activeWalk.nearestMm, distance(offset));
    if (offset.isNear && distance(offset) > activeWalk.nearestMm + MAX_OUTWARD_MM) this.cut(activeWalk);
  }

  /** Notes a line that was sent to the robot; one that another part of the page has sent may end the protocol. */
  noteSent(line: string): void {
    const isWalk = ({ command }: PredictedCycle) => line === command || line.startsWith(`${command} `);
    if (line === WORDS.stop) this.end('it was stopped');
    else if (line !== this.lastSent && this.stage.predictions().some(isWalk)) this.end(`the robot was sent "${line}"`);
  }

  /** Notes a line from the robot: `DONE_LINE` ends a walk, and arrives before `setActivity` is called. */
  noteReceived(line: string): void {
    if (line !== DONE_LINE || !this.activeWalk) return;
    this.finish(this.activeWalk);
    this.activeWalk = null;
  }

  /** Sets the robot's current activity; one that the protocol has not asked for ends the protocol. */
  setActivity(activity: string): void {
    const { activeWalk } = this;
    const isWalking = activeWalk?.gait === activity;
    const isStanding = activity === WORDS.stop || activity === GAITS.stand;
    if (isWalking || (isStanding && (activeWalk === null || activeWalk.isCut))) return;
    this.end(activity === '' ? 'the link to the robot was cut, or it was reset' : `the robot does "${activity}"`);
  }

  /** Ends the protocol for an external reason, such as a camera that was switched off, and stops a walking robot. */
  stop(reason: string): void {
    const wasWalking = this.activeWalk !== null;
    this.end(reason);
    if (wasWalking) void this.stage.ask(WORDS.stop);
  }

  /** Ends the protocol: nothing more is sent. */
  end(reason: string): void {
    this.endReason ??= new Interrupted(reason);
    if (this.activeWalk) this.finish(this.activeWalk, this.endReason);
    this.activeWalk = null;
    this.onEnd();
  }

  /** The robot's last offset; null if the camera has not detected the robot for `MAX_UNSEEN_S`. */
  private get lastOffset(): OffsetToMiddle | null {
    return this.lastSighting && this.stage.now() - this.lastSighting.seconds < MAX_UNSEEN_S ? this.lastSighting.offset : null;
  }

  /**
   * Brings the robot back to the middle if it is near the edge of the sheet, by a gait or else by hand. If only the
   * next walk, of `forwardMm`, would leave the sheet, the robot returns only if a gait can take it to the middle.
   */
  private async goBack(forwardMm: number): Promise<void> {
    for (let attempt = 0; ; attempt++) {
      const { lastOffset: offset, stage } = this;
      const isOnSheet = offset !== null && !offset.isNear;
      const wouldLeave = offset !== null && attempt === 0 && distance(offset) > RETURN_DISTANCE_MM && Math.hypot(offset.forward - forwardMm, offset.left) > offset.reach;
      if (isOnSheet && !wouldLeave) return;
      const gait = offset && attempt < RETURN_LIMITS.maxAttempts && Math.abs(offset.forward) > RETURN_LIMITS.minForwardShare * distance(offset) ? this.gaitToward(offset.forward) : null;
      if (offset && gait) {
        stage.showProgress(`Back to the middle by ${gait.command}`);
        await this.walk(gait.command, Math.min(RETURN_LIMITS.maxCycles, Math.max(1, Math.round(offset.forward / gait.forward))));
      } else if (isOnSheet) return;
      else await stage.putBack();
      this.throwIfEnded();
    }
  }

  /** Returns the gait that walks farthest forward (backward if `offsetMm` is negative) and hardly turns, or null. */
  private gaitToward(offsetMm: number): PredictedCycle | null {
    const progressOf = ({ forward, turn }: PredictedCycle) => (Math.abs(turn) < RETURN_GAIT.maxTurnDeg ? forward * Math.sign(offsetMm) : 0);
    const [best] = this.stage.predictions().sort((a, b) => progressOf(b) - progressOf(a));
    return best && progressOf(best) > RETURN_GAIT.minForwardMm ? best : null;
  }

  /**
   * Walks a gait to its last cycle, or to the edge of the sheet. Returns the start and the end of the walk, s; `record`
   * is called with them even if the walk is interrupted.
   */
  private async walk(gait: string, cycles: number, record: (during: [number, number]) => void = () => {}): Promise<[number, number]> {
    const { stage } = this;
    const activeWalk: ActiveWalk = { gait, nearestMm: null, isCut: false, endSeconds: null, resolve: () => {}, reject: () => {} };
    const walkEnd = new Promise<void>((resolve, reject) => Object.assign(activeWalk, { resolve, reject }));
    // The promise may reject before it is awaited.
    walkEnd.catch(() => {});
    this.activeWalk = activeWalk;
    const start = stage.now();
    await this.ask(`${gait} ${cycles}`);
    activeWalk.nearestMm = this.lastOffset ? distance(this.lastOffset) : Infinity;
    void this.watch(activeWalk);
    try {
      await walkEnd;
    } finally {
      record([start, activeWalk.endSeconds ?? start]);
    }
    if (activeWalk.isCut) {
      await this.ask(GAITS.stand);
      this.activeWalk = null;
    }
    return [start, activeWalk.endSeconds ?? start];
  }

  /** Ends a walk when the robot is no longer detected. */
  private async watch(activeWalk: ActiveWalk): Promise<void> {
    while (this.activeWalk === activeWalk && !activeWalk.isCut) {
      if (!this.lastOffset) return this.cut(activeWalk);
      await this.stage.wait(MAX_UNSEEN_S / 4);
    }
  }

  /** Ends a walk before its last cycle; the robot walks on until it is told to stand. */
  private cut(activeWalk: ActiveWalk): void {
    activeWalk.isCut = true;
    this.finish(activeWalk);
  }

  private finish(activeWalk: ActiveWalk, error?: Error): void {
    activeWalk.endSeconds ??= this.stage.now();
    if (error) activeWalk.reject(error);
    else activeWalk.resolve();
  }

  private throwIfEnded(): void {
    if (this.endReason) throw this.endReason;
  }

  private async wait(seconds: number): Promise<void> {
    await this.stage.wait(seconds);
    this.throwIfEnded();
  }

  private async ask(line: string): Promise<void> {
    this.throwIfEnded();
    this.lastSent = line;
    if (!(await this.stage.ask(line))) this.stop(`the robot did not accept "${line}"`);
    this.throwIfEnded();
  }
}
