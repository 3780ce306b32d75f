// The robot's path in the last seconds, which gives the displacement in a cycle.
import { type Frame, Robot } from './robot';

/** Duration of the kept path: enough for a cycle of 3 s at a pace of 10 %. */
const KEPT_SECONDS = 31;

/**
 * The displacement in the last cycle, in the robot's frame at the cycle's start: `forward` and `left` in mm, `turn` in
 * deg counter-clockwise. `lag` is the largest lag of a leg in this cycle, deg.
 */
export type CycleDisplacement = ReturnType<typeof Robot.displacementBetween> & { lag: number };

export class WalkedPath {
  private frames: { time: number; frame: Frame }[] = [];
  /** Sum of the durations of all frames, s. */
  private time = 0;
  /** Duration of the last frame. */
  private frameSeconds = 0.02;

  /** Clears the path; must be called before frames of another gait, pace or robot. */
  clear(): void {
    this.frames = [];
  }

  add(frame: Frame, seconds: number): void {
    this.time += seconds;
    this.frameSeconds = seconds;
    this.frames.push({ time: this.time, frame });
    while (this.frames[0].time < this.time - KEPT_SECONDS) this.frames.shift();
  }

  /** Computes the displacement in the last `cycleSeconds` seconds; returns null if the path is shorter. */
  computeDisplacement(cycleSeconds: number): CycleDisplacement | null {
    const lastFrame = this.frames.at(-1);
    if (!lastFrame) return null;
    // The cycle starts at the nearest known frame, because a real board does not report every frame.
    const startIndex = this.frames.findLastIndex(({ time }) => time <= lastFrame.time - cycleSeconds + this.frameSeconds / 2);
    if (startIndex < 0) return null;
    const lags = this.frames.slice(startIndex + 1).flatMap(({ frame }) => frame.lags.map(Math.abs));
    return { ...Robot.displacementBetween(this.frames[startIndex].frame.place, lastFrame.frame.place), lag: Math.max(0, ...lags) };
  }
}
