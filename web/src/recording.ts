// A recorded run of the robot, frame by frame, for replay and export.
import type { Four, Frame } from './robot';

/** A frame in a recording, with its time, activity and pulses. */
export interface RecordedFrame {
  /** Time since the start of the recording, s. */
  time: number;
  /** The robot's gait or command in this frame. */
  activity: string;
  frame: Frame;
  /** Pulse widths, CPU cycles; null for a real board, whose pulses are unknown. */
  widths: Four<number> | null;
}

/** Longest duration of a recording, s, so that a forgotten recording does not fill the memory. */
export const MAX_RECORDING_SECONDS = 180;
const CYCLES_PER_US = 16;

export class Recording {
  readonly frames: RecordedFrame[] = [];

  /** Adds a frame that lasts `seconds`; returns false once the recording is full. */
  add(frame: Frame, widths: Four<number> | null, activity: string, seconds: number): boolean {
    const lastFrame = this.frames[this.frames.length - 1];
    this.frames.push({ time: lastFrame ? lastFrame.time + seconds : 0, activity, frame, widths });
    return this.duration < MAX_RECORDING_SECONDS;
  }

  /** Duration so far, s. */
  get duration(): number {
    return this.frames[this.frames.length - 1]?.time ?? 0;
  }

  /** Returns the current frame at `time`, s; null if the recording is empty. */
  frameAt(time: number): RecordedFrame | null {
    const laterIndex = this.frames.findIndex((frame) => frame.time > time + 1e-9);
    return this.frames[laterIndex < 0 ? this.frames.length - 1 : Math.max(0, laterIndex - 1)] ?? null;
  }

  /** Formats the recording as CSV, one line per frame: angles and lags in deg, place in mm, pulses in us. */
  formatCsv(): string {
    const nameServos = (makeName: (number: number) => string) => [1, 2, 3, 4].map(makeName);
    const header = [
      'time_s', 'doing', ...nameServos((n) => `a${n}_deg`), 'right_mm', 'ahead_mm', 'heading_deg',
      ...['lf', 'rf', 'rh', 'lh'].map((leg) => `lag_${leg}_deg`), ...nameServos((n) => `pulse_a${n}_us`),
    ];
    const emptyFields = ['', '', '', ''];
    const lines = this.frames.map(({ time, activity, frame: { scene, place, lags }, widths }) => [
      time.toFixed(2),
      // A gait's name comes from outside, from a file or a board; the quotes keep it from ending the field.
      `"${activity.replaceAll('"', '""')}"`,
      ...(scene?.angles.map((angle) => angle.toFixed(3)) ?? emptyFields),
      ...[place.x, place.y, place.heading].map((value) => (Number(value.toFixed(2)) + 0).toFixed(2)),
      ...lags.map((value) => value.toFixed(3)),
      ...(widths?.map((width) => (width / CYCLES_PER_US).toFixed(2)) ?? emptyFields),
    ]);
    return `${[header, ...lines].map((fields) => fields.join(',')).join('\n')}\n`;
  }
}
