// The robot's path of the last seconds, from which the page measures a cycle.
import { type Frame, Robot } from './robot';

/** Seconds of path kept: 3 s at a tenth of the pace. */
const KEPT_SECONDS = 31;
const FRAME_SECONDS = 0.02;

/** The last cycle: mm forward and left in the frame of its start, turn and largest lag of a leg, deg. */
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

  /** Forgets the path: what follows belongs to another gait, pace or robot. */
  clear(): void {
    this.places = [];
  }

  /** Adds a frame that has taken a time, s. */
  add(frame: Frame, seconds: number): void {
    this.time += seconds;
    this.step = seconds;
    this.places.push({ time: this.time, frame });
    while (this.places[0].time < this.time - KEPT_SECONDS) this.places.shift();
  }

  /** Displacement in the last cycle of a duration, s; null before one is complete. */
  measured(cycle: number): Measured | null {
    const now = this.places.at(-1);
    if (!now) return null;
    // The nearest known frame: a board on USB does not send every frame.
    const from = this.places.findLastIndex(({ time }) => time <= now.time - cycle + this.step / 2);
    if (from < 0) return null;
    const lags = this.places.slice(from + 1).flatMap(({ frame }) => frame.lag.map(Math.abs));
    return { ...Robot.between(this.places[from].frame.place, now.frame.place), lag: Math.max(0, ...lags) };
  }
}
