// Records a drive as the steps of a routine, from the robot's reports of its gait, its pace and the phase of the
// cycle. All times are in seconds of `Session.clock`.
import type { Gait } from '../robot';
import { GAITS, WORDS } from '../words';

/** Shortest pause that becomes a step, s: a thumb that changes direction lets go for a moment. */
const SHORTEST_PAUSE_S = 0.5;
/** Shortest step, s. */
const SHORTEST_STEP_S = 0.1;
/** Largest error, in cycles, of a count since the last phase that the robot reported. */
const COUNT_TOLERANCE_CYCLES = 0.05;
/**
 * Added before a count is rounded down to whole cycles; below 0.5, because the count includes the move to the first
 * pose with which a gait begins.
 */
const ROUNDING_OFFSET_CYCLES = 0.4;
/** The robot's activities between gaits; a routine has only `stand` for them. */
const PAUSE_ACTIVITIES: string[] = ['', GAITS.stand, WORDS.stop, WORDS.pose, WORDS.center];

/** A part of the drive with one activity. */
interface DrivePart {
  name: string;
  /** Number of whole cycles; 0 for a part that is measured by time. */
  cycles: number;
  seconds: number;
}

const isPause = ({ name }: DrivePart) => name === GAITS.stand;
/** True for a part that is too short to be a step. */
const isShort = (part: DrivePart) => part.seconds < (isPause(part) ? SHORTEST_PAUSE_S : SHORTEST_STEP_S);

export class Recorder {
  private parts: DrivePart[] = [];
  /** Cycles of the current gait until the time `countedUntil`. */
  private cycles = 0;
  private countedUntil: number;

  /** Begins at the time `gaitStart` with the robot's activity `gait` and its pace, percent. */
  constructor(
    private readonly gaits: Gait[],
    private gait: string,
    private pace: number,
    private gaitStart: number,
  ) {
    this.countedUntil = gaitStart;
  }

  /** Takes the robot's current activity. */
  setGait(gait: string, time: number): void {
    if (gait === this.gait) return;
    this.parts = this.partsUntil(time);
    [this.gait, this.gaitStart, this.countedUntil, this.cycles] = [gait, time, time, 0];
  }

  /** Takes a new pace, percent. */
  setPace(percent: number, time: number): void {
    this.countCycles(time);
    this.pace = percent;
  }

  /** Takes the reported phase of the robot's gait. */
  setPhase(reportedPhase: number, time: number): void {
    this.countCycles(time);
    const phase = this.currentGait?.reversed ? (1 - reportedPhase) % 1 : reportedPhase;
    // The count is never too low, so a phase ahead of it belongs to the previous gait: the robot reports that phase
    // until it has reached the first pose of the new gait.
    if (phase > this.cycles + COUNT_TOLERANCE_CYCLES) {
      this.cycles = 0;
      return;
    }
    this.cycles = Math.floor(this.cycles + ROUNDING_OFFSET_CYCLES - phase) + phase;
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

  private countCycles(time: number): void {
    const { period } = this.currentGait ?? {};
    if (period !== undefined) this.cycles += ((time - this.countedUntil) * this.pace) / 100 / period;
    this.countedUntil = time;
  }

  /** Returns all parts until a time, the current activity as the last one; successive pauses are one part. */
  private partsUntil(time: number): DrivePart[] {
    this.countCycles(time);
    const { parts, gait, currentGait } = this;
    const seconds = time - this.gaitStart;
    const part = PAUSE_ACTIVITIES.includes(gait)
      ? { name: GAITS.stand, cycles: 0, seconds }
      : { name: gait, cycles: currentGait ? Math.max(0, Math.floor(this.cycles + COUNT_TOLERANCE_CYCLES)) : 0, seconds };
    const previous = parts.at(-1);
    if (!previous || !isPause(part) || !isPause(previous)) return [...parts, part];
    return [...parts.slice(0, -1), { ...previous, seconds: previous.seconds + seconds }];
  }
}
