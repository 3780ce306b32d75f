// The protocol of a measurement: drives gaits one after another in front of a camera, keeps the robot near the sheet of
// tags, and records the times of each walk. The protocol ends at any other activity of the robot, such as `stop` or
// another gait, and when the link is lost.
import { DONE_LINE, STAND, WORDS } from '../words';
import type { OffsetToCentre } from './tag-tracker';

/**
 * Limits of a return to the centre of the sheet by a gait: cycles per attempt, attempts, and the smallest fraction of
 * the distance that must lie ahead or behind.
 */
const RETURN_LIMITS = { maxCycles: 12, maxAttempts: 2, minForwardFraction: 0.7 };
/** Conditions for a gait with which the robot can return: smallest distance and largest turn per cycle. */
const RETURN_GAIT = { minForwardMm: 3, maxTurnDeg: 2 };
/** Distance from the centre, mm, beyond which the robot first returns if the next walk would leave the sheet. */
const RETURN_DISTANCE_MM = 80;
/** Outward movement near the edge of the sheet that ends a walk, mm; larger than the body's swing within a cycle. */
const MAX_OUTWARD_MM = 20;
/** Time for which the robot may walk without being detected by the camera, s. */
const MAX_UNSEEN_S = 2;
/**
 * Smallest number of cycles of a walk, whose first and last cycle are not measured. A walk that was cut shorter counts
 * as this many cycles.
 */
export const MIN_CYCLES = 4;

/** A measured walk of the robot. */
export interface Walk {
  gait: string;
  /** Start and end on the video's clock, s. */
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
   * Number of cycles of each gait. If the edge of the sheet cuts a walk short, the remaining cycles follow when the
   * robot is back in the centre.
   */
  cycles: number;
  /** Pace of all gaits, percent. */
  speed: number;
  /** Pause between two walks, s. */
  pause: number;
}

/** The protocol's interface to the robot, the camera and the user. */
export interface ProtocolEnvironment {
  /** Sends a line; resolves to true if the robot accepts it. */
  ask: (line: string) => Promise<boolean>;
  /** The video's clock, s. */
  now: () => number;
  /** Waits for `seconds`, in the robot's time. */
  wait: (seconds: number) => Promise<void>;
  /** Returns the predicted displacements of all gaits that have a prediction. */
  predictions: () => PredictedCycle[];
  /** Asks the user to put the robot back; resolves when the robot is back, or when the protocol has ended. */
  putBack: () => Promise<void>;
  showProgress: (text: string) => void;
}

/** Thrown when the protocol ends before its last walk; `message` is the reason. */
export class ProtocolInterrupted extends Error {}

/** A walk that has not ended yet. */
interface ActiveWalk {
  gait: string;
  /** Smallest distance of the robot from the centre so far, mm; null until the robot has accepted the gait. */
  nearestMm: number | null;
  /** True if the walk was ended before its last cycle. */
  isCutShort: boolean;
  /** Ends the walk now, with an error if the whole protocol has ended; has no effect on an ended walk. */
  finish: (error?: Error) => void;
}

const distance = ({ forward, left }: OffsetToCentre) => Math.hypot(forward, left);

export class Protocol {
  /** The measured walks so far, without returns. */
  readonly walks: Walk[] = [];
  private activeWalk: ActiveWalk | null = null;
  /** The last line that the protocol has sent. */
  private lastSent = '';
  /** Called when the protocol ends. */
  onEnd: () => void = () => {};
  /** The reason why the protocol has ended; null until then. */
  private endReason: ProtocolInterrupted | null = null;
  /** The last detected offset, and its time on the video's clock, s; null before the first. */
  private lastSighting: { offset: OffsetToCentre; seconds: number } | null = null;

  constructor(private readonly environment: ProtocolEnvironment) {}

  /** Drives all gaits of a plan. Throws {@link ProtocolInterrupted}; `walks` then has the walks so far. */
  async run({ gaits, cycles, speed, pause }: Plan): Promise<void> {
    const { environment } = this;
    await this.ask(`${WORDS.speed} ${speed}`);
    for (const [i, { command, period }] of gaits.entries()) {
      const { forward = 0 } = environment.predictions().find((predicted) => predicted.command === command) ?? {};
      for (let cyclesLeft = cycles; cyclesLeft >= MIN_CYCLES; ) {
        await this.goBack(cyclesLeft * forward);
        await this.wait(pause);
        environment.showProgress(`${i + 1} of ${gaits.length}: ${command}, ${cyclesLeft} cycles`);
        const [start, end] = await this.walk(command, cyclesLeft, (during) => this.walks.push({ gait: command, during }));
        cyclesLeft -= Math.max(MIN_CYCLES, Math.floor(((end - start) * speed) / 100 / period));
      }
    }
    await this.wait(pause);
  }

  /**
   * Sets the robot's offset in the latest frame; null if the frame does not show the robot. Ends a walk that leaves the
   * sheet.
   */
  setOffset(offset: OffsetToCentre | null): void {
    if (!offset) return;
    this.lastSighting = { offset, seconds: this.environment.now() };
    const { activeWalk } = this;
    if (activeWalk === null || activeWalk.nearestMm === null) return;
    activeWalk.nearestMm = Math.min(activeWalk.nearestMm, distance(offset));
    if (offset.isNearEdge && distance(offset) > activeWalk.nearestMm + MAX_OUTWARD_MM) this.cutShort(activeWalk);
  }

  /** Handles a line that was sent to the robot. A line from another part of the page may end the protocol. */
  handleSent(line: string): void {
    const isWalk = ({ command }: PredictedCycle) => line === command || line.startsWith(`${command} `);
    if (line === WORDS.stop) this.end('it was stopped');
    else if (line !== this.lastSent && this.environment.predictions().some(isWalk)) this.end(`the robot was sent "${line}"`);
  }

  /** Handles a line from the robot. `DONE_LINE` ends a walk, and arrives before `setActivity` is called. */
  handleReceived(line: string): void {
    if (line !== DONE_LINE || !this.activeWalk) return;
    this.activeWalk.finish();
    this.activeWalk = null;
  }

  /** Sets the robot's current activity. An activity that the protocol has not requested ends the protocol. */
  setActivity(activity: string): void {
    const { activeWalk } = this;
    const isWalking = activeWalk?.gait === activity;
    const isStanding = activity === WORDS.stop || activity === STAND;
    if (isWalking || (isStanding && (activeWalk === null || activeWalk.isCutShort))) return;
    this.end(activity === '' ? 'the link to the robot was cut, or it was reset' : `the robot does "${activity}"`);
  }

  /** Ends the protocol for an external reason, such as a camera that was switched off. Stops a walking robot. */
  stop(reason: string): void {
    const wasWalking = this.activeWalk !== null;
    this.end(reason);
    if (wasWalking) void this.environment.ask(WORDS.stop);
  }

  /** Ends the protocol: nothing more is sent. */
  end(reason: string): void {
    this.endReason ??= new ProtocolInterrupted(reason);
    this.activeWalk?.finish(this.endReason);
    this.activeWalk = null;
    this.onEnd();
  }

  /** The robot's last offset; null if the camera has not detected the robot for `MAX_UNSEEN_S`. */
  private get lastOffset(): OffsetToCentre | null {
    return this.lastSighting && this.environment.now() - this.lastSighting.seconds < MAX_UNSEEN_S ? this.lastSighting.offset : null;
  }

  /**
   * Brings the robot back to the centre if it is near the edge of the sheet, by a gait or else by hand. If only the
   * next walk, of `forwardMm`, would leave the sheet, the robot returns only if a gait can take it to the centre.
   */
  private async goBack(forwardMm: number): Promise<void> {
    for (let attempt = 0; ; attempt++) {
      const { lastOffset: offset, environment } = this;
      const isOnSheet = offset !== null && !offset.isNearEdge;
      const wouldLeave = offset !== null && attempt === 0 && distance(offset) > RETURN_DISTANCE_MM && Math.hypot(offset.forward - forwardMm, offset.left) > offset.reach;
      if (isOnSheet && !wouldLeave) return;
      const gait = offset && attempt < RETURN_LIMITS.maxAttempts && Math.abs(offset.forward) > RETURN_LIMITS.minForwardFraction * distance(offset) ? this.findGaitToward(offset.forward) : null;
      if (offset && gait) {
        environment.showProgress(`Back to the centre by ${gait.command}`);
        await this.walk(gait.command, Math.min(RETURN_LIMITS.maxCycles, Math.max(1, Math.round(offset.forward / gait.forward))));
      } else if (isOnSheet) return;
      else await environment.putBack();
      this.throwIfEnded();
    }
  }

  /** Finds the gait that moves farthest forward (back if `offsetMm` is negative) and hardly turns, if there is one. */
  private findGaitToward(offsetMm: number): PredictedCycle | null {
    const progress = ({ forward, turn }: PredictedCycle) => (Math.abs(turn) < RETURN_GAIT.maxTurnDeg ? forward * Math.sign(offsetMm) : 0);
    const [best] = this.environment.predictions().sort((a, b) => progress(b) - progress(a));
    return best && progress(best) > RETURN_GAIT.minForwardMm ? best : null;
  }

  /**
   * Drives a gait to its last cycle, or to the edge of the sheet. Returns the start and the end of the walk, s;
   * `record` is called with both even if the walk is interrupted.
   */
  private async walk(gait: string, cycles: number, record: (during: [number, number]) => void = () => {}): Promise<[number, number]> {
    const { environment } = this;
    const activeWalk: ActiveWalk = { gait, nearestMm: null, isCutShort: false, finish: () => {} };
    const walkEnd = new Promise<{ end: number; error?: Error }>((resolve) => {
      activeWalk.finish = (error) => resolve({ end: environment.now(), error });
    });
    this.activeWalk = activeWalk;
    const start = environment.now();
    await this.ask(`${gait} ${cycles}`);
    activeWalk.nearestMm = this.lastOffset ? distance(this.lastOffset) : Infinity;
    void this.cutShortWhenUnseen(activeWalk);
    const { end, error } = await walkEnd;
    record([start, end]);
    if (error) throw error;
    if (activeWalk.isCutShort) {
      await this.ask(STAND);
      this.activeWalk = null;
    }
    return [start, end];
  }

  /** Ends a walk when the camera no longer detects the robot. */
  private async cutShortWhenUnseen(activeWalk: ActiveWalk): Promise<void> {
    while (this.activeWalk === activeWalk && !activeWalk.isCutShort) {
      if (!this.lastOffset) return this.cutShort(activeWalk);
      await this.environment.wait(MAX_UNSEEN_S / 4);
    }
  }

  /** Ends a walk before its last cycle; the robot walks on until it is told to stand. */
  private cutShort(activeWalk: ActiveWalk): void {
    activeWalk.isCutShort = true;
    activeWalk.finish();
  }

  private throwIfEnded(): void {
    if (this.endReason) throw this.endReason;
  }

  private async wait(seconds: number): Promise<void> {
    await this.environment.wait(seconds);
    this.throwIfEnded();
  }

  private async ask(line: string): Promise<void> {
    this.throwIfEnded();
    this.lastSent = line;
    if (!(await this.environment.ask(line))) this.stop(`the robot did not accept "${line}"`);
    this.throwIfEnded();
  }
}
