// A recorded run of the robot, frame by frame, for replay and for export.
import type { Four, Frame } from './robot';

/** One frame of a recording. */
export interface RecordedFrame {
  /** Time since the recording began, s. */
  time: number;
  /** The gait or command of this frame. */
  doing: string;
  frame: Frame;
  /** Pulse widths, CPU cycles; null for a board on USB, which does not show its pulses. */
  widths: Four<number> | null;
}

/** Longest recording, s, so that a forgotten one does not fill the memory. */
export const LONGEST = 180;
const CYCLES_PER_US = 16;

export class Recording {
  readonly moments: RecordedFrame[] = [];

  /** Adds a frame that lasts `seconds`; returns true while there is room for more. */
  note(frame: Frame, widths: Four<number> | null, doing: string, seconds: number): boolean {
    const lastMoment = this.moments[this.moments.length - 1];
    this.moments.push({ time: lastMoment ? lastMoment.time + seconds : 0, doing, frame, widths });
    return this.seconds < LONGEST;
  }

  get seconds(): number {
    return this.moments[this.moments.length - 1]?.time ?? 0;
  }

  /** Returns the frame that was current at a time, s; null if the recording is empty. */
  frameAt(time: number): RecordedFrame | null {
    const laterIndex = this.moments.findIndex((moment) => moment.time > time + 1e-9);
    return this.moments[laterIndex < 0 ? this.moments.length - 1 : Math.max(0, laterIndex - 1)] ?? null;
  }

  /** Formats the recording as CSV, one line per frame: angles and lags in deg, place in mm, pulses in us. */
  csv(): string {
    const fourNames = (name: (number: number) => string) => [1, 2, 3, 4].map(name);
    const header = [
      'time_s', 'doing', ...fourNames((n) => `a${n}_deg`), 'right_mm', 'ahead_mm', 'heading_deg',
      ...['lf', 'rf', 'rh', 'lh'].map((leg) => `lag_${leg}_deg`), ...fourNames((n) => `pulse_a${n}_us`),
    ];
    const emptyFields = ['', '', '', ''];
    const lines = this.moments.map(({ time, doing, frame: { scene, place, lag }, widths }) => [
      time.toFixed(2),
      // A gait's name comes from a file: it must neither start a formula nor end a field.
      `"${doing.replaceAll('"', '""')}"`,
      ...(scene?.angles.map((angle) => angle.toFixed(3)) ?? emptyFields),
      ...[place.x, place.y, place.heading].map((value) => (Number(value.toFixed(2)) + 0).toFixed(2)),
      ...lag.map((value) => value.toFixed(3)),
      ...(widths?.map((width) => (width / CYCLES_PER_US).toFixed(2)) ?? emptyFields),
    ]);
    return `${[header, ...lines].map((fields) => fields.join(',')).join('\n')}\n`;
  }
}
