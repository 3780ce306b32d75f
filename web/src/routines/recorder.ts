// Records a drive as the steps of a routine, from the robot's reports of its gait, its pace and the phase of the
// cycle. All times are in seconds of `Session.clock`.
import type { Gait } from '../robot';
import { GAITS, WORDS } from '../words';

/** Shortest pause that becomes a step, s: a thumb that changes direction lets go for a moment. */
const SHORTEST_PAUSE = 0.5;
/** Shortest step, s. */
const SHORTEST_STEP = 0.1;
/** Largest error, in cycles, of a count since the last phase that the robot reported. */
const SLACK = 0.05;
/**
 * Added before a count is rounded down to whole cycles; below 0.5, because the count includes the move to the first
 * pose with which a gait begins.
 */
const ROUNDING = 0.4;
/** The robot's activities between gaits; a routine has only `stand` for them. */
const PAUSES: string[] = ['', GAITS.stand, WORDS.stop, WORDS.pose, WORDS.center];

interface Part {
  name: string;
  /** Number of whole cycles; 0 for a part that is measured by time. */
  cycles: number;
  seconds: number;
}

const isPause = ({ name }: Part) => name === GAITS.stand;
/** True for a part that is too short to be a step. */
const isShort = (part: Part) => part.seconds < (isPause(part) ? SHORTEST_PAUSE : SHORTEST_STEP);

export class Recorder {
  private parts: Part[] = [];
  /** Cycles of the current gait until the time `countedUntil`. */
  private cycles = 0;
  private countedUntil: number;

  /** Begins at the time `since` with the robot's activity `gait` and its pace, percent. */
  constructor(
    private readonly gaits: Gait[],
    private gait: string,
    private pace: number,
    private since: number,
  ) {
    this.countedUntil = since;
  }

  /** Takes the robot's current activity. */
  setGait(gait: string, time: number): void {
    if (gait === this.gait) return;
    this.parts = this.partsUntil(time);
    [this.gait, this.since, this.countedUntil, this.cycles] = [gait, time, time, 0];
  }

  /** Takes a new pace, percent. */
  setPace(percent: number, time: number): void {
    this.count(time);
    this.pace = percent;
  }

  /** Takes the reported phase of the robot's gait. */
  setPhase(reportedPhase: number, time: number): void {
    this.count(time);
    const phase = this.currentGait?.reversed ? (1 - reportedPhase) % 1 : reportedPhase;
    // The count is never too low, so a phase ahead of it belongs to the previous gait: the robot reports that phase
    // until it has reached the first pose of the new gait.
    if (phase > this.cycles + SLACK) {
      this.cycles = 0;
      return;
    }
    this.cycles = Math.floor(this.cycles + ROUNDING - phase) + phase;
  }

  /** Returns the steps until a time, from the first gait to the last one. */
  steps(time: number): string[] {
    const parts = this.partsUntil(time).filter((part) => !isShort(part));
    const firstIndex = parts.findIndex((part) => !isPause(part));
    const lastIndex = parts.findLastIndex((part) => !isPause(part));
    const steps = firstIndex < 0 ? [] : parts.slice(firstIndex, lastIndex + 1);
    return steps.map(({ name, cycles, seconds }) => `${name} ${cycles || `${Number(seconds.toFixed(1))} s`}`);
  }

  private get currentGait(): Gait | undefined {
    return this.gaits.find(({ command }) => command === this.gait);
  }

  private count(time: number): void {
    const { period } = this.currentGait ?? {};
    if (period !== undefined) this.cycles += ((time - this.countedUntil) * this.pace) / 100 / period;
    this.countedUntil = time;
  }

  /** Returns all parts until a time, the current activity as the last one; successive pauses are one part. */
  private partsUntil(time: number): Part[] {
    this.count(time);
    const { parts, gait, currentGait } = this;
    const seconds = time - this.since;
    const part = PAUSES.includes(gait)
      ? { name: GAITS.stand, cycles: 0, seconds }
      : { name: gait, cycles: currentGait ? Math.max(0, Math.floor(this.cycles + SLACK)) : 0, seconds };
    const previous = parts.at(-1);
    if (!previous || !isPause(part) || !isPause(previous)) return [...parts, part];
    return [...parts.slice(0, -1), { ...previous, seconds: previous.seconds + seconds }];
  }
}
