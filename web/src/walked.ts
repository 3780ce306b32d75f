// The robot's path in the last seconds, from which the page measures the displacement of a cycle.
import { type Frame, Robot } from './robot';

/** Seconds of path that are kept: enough for a cycle of 3 s at a tenth of its pace. */
const KEPT_SECONDS = 31;
const FRAME_SECONDS = 0.02;

/**
 * The displacement in the last cycle: mm forward and left in the frame of the cycle's start, turn in deg; and the
 * largest lag, deg.
 */
export interface Measured {
  forward: number;
  left: number;
  turn: number;
  lag: number;
}

export class WalkedPath {
  private places: { time: number; frame: Frame }[] = [];
  private time = 0;
  private step = FRAME_SECONDS;

  /** Forgets the path, since the following frames belong to another gait, pace or robot. */
  clear(): void {
    this.places = [];
  }

  /** Adds a frame that lasts `seconds`. */
  add(frame: Frame, seconds: number): void {
    this.time += seconds;
    this.step = seconds;
    this.places.push({ time: this.time, frame });
    while (this.places[0].time < this.time - KEPT_SECONDS) this.places.shift();
  }

  /** Returns the displacement in the last `cycleSeconds` seconds; null if the path is shorter. */
  measured(cycleSeconds: number): Measured | null {
    const lastPlace = this.places.at(-1);
    if (!lastPlace) return null;
    // The nearest known frame: a real board does not report every frame.
    const startIndex = this.places.findLastIndex(({ time }) => time <= lastPlace.time - cycleSeconds + this.step / 2);
    if (startIndex < 0) return null;
    const lags = this.places.slice(startIndex + 1).flatMap(({ frame }) => frame.lag.map(Math.abs));
    return { ...Robot.between(this.places[startIndex].frame.place, lastPlace.frame.place), lag: Math.max(0, ...lags) };
  }
}
