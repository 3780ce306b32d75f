// Collects single pulses into frames, which have the pulse widths of all four servos in 20 ms.
import type { Four } from '../robot';
import { FREQUENCY_HZ } from './simulated-board';

/** Longest time between a frame's first rising edge and its end: slightly more than its four slots of 4 ms. */
const MAX_FRAME_CYCLES = 0.0165 * FREQUENCY_HZ;

export class FrameCollector {
  private widths: Four<number> = [0, 0, 0, 0];
  /** The cycle of the frame's first rising edge; null before this edge. */
  private startCycle: number | null = null;
  /** The servo of the frame's last pulse; -1 before the first pulse. */
  private lastServo = -1;

  /** `pins` are the Arduino numbers of the pins of servos A1 to A4. */
  constructor(
    private readonly pins: number[],
    private readonly onFrame: (widths: Four<number>) => void,
  ) {}

  /** Adds a pulse: the Arduino number of its pin, the cycle of its rising edge, and its width in cycles. */
  add(pin: number, riseCycle: number, width: number): void {
    const servo = this.pins.indexOf(pin);
    if (servo < 0) return;
    // A pulse of the same servo, or of an earlier servo, starts a new frame.
    if (servo <= this.lastServo) this.closeFrame();
    this.startCycle ??= riseCycle;
    this.lastServo = servo;
    this.widths[servo] = width;
    if (servo === 3) this.closeFrame();
  }

  /** Closes the frame if its time is over at `cycle`, even if some servos had no pulse. */
  advanceTo(cycle: number): void {
    if (this.startCycle !== null && cycle - this.startCycle > MAX_FRAME_CYCLES) this.closeFrame();
  }

  private closeFrame(): void {
    if (this.startCycle === null) return;
    const { widths } = this;
    this.widths = [0, 0, 0, 0];
    this.startCycle = null;
    this.lastServo = -1;
    this.onFrame(widths);
  }
}
