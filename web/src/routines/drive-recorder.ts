// Records a drive as the steps of a routine, from the robot's reports of its gait, its pace and the phase of its cycle.
// All times are in seconds of `Session.clock`.
import type { Gait } from '../robot';
import { STAND, WORDS } from '../words';

/** Shortest pause that becomes a step, s: a thumb that changes direction briefly releases the stick. */
const MIN_PAUSE_S = 0.5;
/** Shortest activity other than a pause that becomes a step, s. */
const MIN_STEP_S = 0.1;
/** Largest error of the count since the last reported phase, in cycles. */
const COUNT_TOLERANCE_CYCLES = 0.05;
/**
 * Number of cycles added to the count before it is rounded down to whole cycles. It is below 0.5, because the count
 * includes the move to the gait's first pose.
 */
const ROUNDING_OFFSET_CYCLES = 0.4;
/** The robot's activities between gaits, which become the step `stand` in a routine. */
const PAUSE_ACTIVITIES: string[] = ['', STAND, WORDS.stop, WORDS.pose, WORDS.center];

/** A section of the drive with one activity. */
interface Section {
  name: string;
  /** Number of whole cycles; 0 if the section is measured in time. */
  cycles: number;
  seconds: number;
}

const isPause = ({ name }: Section) => name === STAND;
/** Returns true if a section is too short to become a step. */
const isTooShort = (section: Section) => section.seconds < (isPause(section) ? MIN_PAUSE_S : MIN_STEP_S);

export class DriveRecorder {
  private sections: Section[] = [];
  /** Cycles of the current gait until `countedUntil`. */
  private cycles = 0;
  /** The time until which the cycles are counted. */
  private countedUntil: number;

  /** Starts at `activityStart` with the robot's activity and its pace, percent. */
  constructor(
    private readonly gaits: Gait[],
    private activity: string,
    private pace: number,
    private activityStart: number,
  ) {
    this.countedUntil = activityStart;
  }

  /** Records that the robot's activity is `activity` from `time` on. */
  setActivity(activity: string, time: number): void {
    if (activity === this.activity) return;
    this.sections = this.listSections(time);
    [this.activity, this.activityStart, this.countedUntil, this.cycles] = [activity, time, time, 0];
  }

  /** Records that the robot's pace is `percent` from `time` on. */
  setPace(percent: number, time: number): void {
    this.countCycles(time);
    this.pace = percent;
  }

  /** Corrects the cycle count with the phase of the gait, 0 to 1, that the robot reports. */
  setPhase(reportedPhase: number, time: number): void {
    this.countCycles(time);
    const phase = this.currentGait?.reversed ? (1 - reportedPhase) % 1 : reportedPhase;
    // The count is never too low; therefore a phase above the count belongs to the previous gait: the robot reports
    // that gait's phase until it reaches the new gait's first pose.
    if (phase > this.cycles + COUNT_TOLERANCE_CYCLES) this.cycles = 0;
    else this.cycles = Math.floor(this.cycles + ROUNDING_OFFSET_CYCLES - phase) + phase;
  }

  /** Returns the steps until `time`, from the first gait to the last gait. */
  listSteps(time: number): string[] {
    const sections = this.listSections(time).filter((section) => !isTooShort(section));
    const firstIndex = sections.findIndex((section) => !isPause(section));
    const lastIndex = sections.findLastIndex((section) => !isPause(section));
    const steps = firstIndex < 0 ? [] : sections.slice(firstIndex, lastIndex + 1);
    return steps.map(({ name, cycles, seconds }) => `${name} ${cycles || `${Number(seconds.toFixed(1))} s`}`);
  }

  private get currentGait(): Gait | undefined {
    return this.gaits.find(({ command }) => command === this.activity);
  }

  private countCycles(time: number): void {
    const { period } = this.currentGait ?? {};
    if (period !== undefined) this.cycles += ((time - this.countedUntil) * this.pace) / 100 / period;
    this.countedUntil = time;
  }

  /** Returns all sections until `time`, including the current activity; consecutive pauses are one section. */
  private listSections(time: number): Section[] {
    this.countCycles(time);
    const { sections, activity, currentGait } = this;
    const seconds = time - this.activityStart;
    const section = PAUSE_ACTIVITIES.includes(activity)
      ? { name: STAND, cycles: 0, seconds }
      : { name: activity, cycles: currentGait ? Math.max(0, Math.floor(this.cycles + COUNT_TOLERANCE_CYCLES)) : 0, seconds };
    const previous = sections.at(-1);
    if (!previous || !isPause(section) || !isPause(previous)) return [...sections, section];
    return [...sections.slice(0, -1), { ...previous, seconds: previous.seconds + seconds }];
  }
}
