// The robot's path in the last seconds, from which the displacement in a cycle is computed.
import { type Frame, Robot } from './robot';

/** Duration of the kept path: enough for a cycle of 3 s at a tenth of its pace. */
const KEPT_SECONDS = 31;
/** Duration of a frame before the first one is added. */
const DEFAULT_FRAME_SECONDS = 0.02;

/**
 * The displacement in the last cycle, in the robot's frame at the start of the cycle: `forward` and `left` in mm,
 * `turn` in deg counter-clockwise. `lag` is the largest lag of a leg in this cycle, deg.
 */
export interface CycleDisplacement {
  forward: number;
  left: number;
  turn: number;
  lag: number;
}

export class WalkedPath {
  private frames: { time: number; frame: Frame }[] = [];
  /** Sum of the durations of all frames, s. */
  private time = 0;
  private frameSeconds = DEFAULT_FRAME_SECONDS;

  /** Clears the path; to be called when the following frames belong to another gait, pace or robot. */
  clear(): void {
    this.frames = [];
  }

  /** Adds a frame that lasts `seconds`. */
  add(frame: Frame, seconds: number): void {
    this.time += seconds;
    this.frameSeconds = seconds;
    this.frames.push({ time: this.time, frame });
    while (this.frames[0].time < this.time - KEPT_SECONDS) this.frames.shift();
  }

  /** Returns the displacement in the last `cycleSeconds` seconds; null if the path is shorter. */
  displacementIn(cycleSeconds: number): CycleDisplacement | null {
    const lastFrame = this.frames.at(-1);
    if (!lastFrame) return null;
    // The cycle starts at the nearest known frame, since a real board does not report every frame.
    const startIndex = this.frames.findLastIndex(({ time }) => time <= lastFrame.time - cycleSeconds + this.frameSeconds / 2);
    if (startIndex < 0) return null;
    const lags = this.frames.slice(startIndex + 1).flatMap(({ frame }) => frame.lag.map(Math.abs));
    return { ...Robot.between(this.frames[startIndex].frame.place, lastFrame.frame.place), lag: Math.max(0, ...lags) };
  }
}
