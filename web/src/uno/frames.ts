// Collects single pulses into frames: the widths of all four servos within 20 ms.
import type { Four } from '../robot';
import { FREQUENCY } from './board';

/** Cycles from a frame's first pulse after which the frame is over: four slots of 4 ms, one for each servo. */
const FOUR_SLOTS = 0.0165 * FREQUENCY;

export class Frames {
  private widths: Four<number> = [0, 0, 0, 0];
  private start: number | null = null;
  private last = -1;

  /** Takes the Arduino pin numbers of the four servos, in their order. */
  constructor(
    private readonly pins: number[],
    private readonly onFrame: (widths: Four<number>, cycle: number) => void,
  ) {}

  add(pin: number, rise: number, width: number): void {
    const servo = this.pins.indexOf(pin);
    if (servo < 0) return;
    // A pulse of the same servo, or of one earlier in the order, starts a new frame.
    if (servo <= this.last) this.close();
    this.start ??= rise;
    this.last = servo;
    this.widths[servo] = width;
    if (servo === 3) this.close();
  }

  /** Closes the frame if its time is over at a cycle, even if not all servos have had a pulse. */
  advanceTo(cycle: number): void {
    if (this.start !== null && cycle - this.start > FOUR_SLOTS) this.close();
  }

  private close(): void {
    if (this.start === null) return;
    const { widths, start } = this;
    this.widths = [0, 0, 0, 0];
    this.start = null;
    this.last = -1;
    this.onFrame(widths, start);
  }
}
