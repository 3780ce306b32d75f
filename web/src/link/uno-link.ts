// The link to a simulated UNO, which runs the image cycle by cycle.
import type { Four } from '../robot';
import { SimulatedBoard, FREQUENCY } from '../uno/board';
import { Frames } from '../uno/frames';
import { type Simulated, Waits } from './link';

const CYCLES_PER_MS = FREQUENCY / 1000;
/** Time that the chip runs between two reads of its output, ms. */
const SLICE = 2;

export interface UnoEvents {
  frame(widths: Four<number>, cycle: number): void;
  pulse(pin: number, rise: number, width: number): void;
}

export class UnoLink implements Simulated {
  readonly kind = 'simulated';
  readonly name = 'simulated UNO';
  onBytes: (bytes: Uint8Array) => void = () => {};
  onGone: (why: string) => void = () => {};
  private readonly waits = new Waits();
  private readonly frames: Frames;
  private sent: number[] = [];
  /** Time that the chip still has to run, cycles. */
  private owed = 0;

  constructor(
    readonly board: SimulatedBoard,
    pins: number[],
    events: UnoEvents,
  ) {
    this.frames = new Frames(pins, events.frame);
    board.onByte = (byte) => this.sent.push(byte);
    board.onPulse = (pin, rise, width) => {
      events.pulse(pin, rise, width);
      this.frames.pulse(pin, rise, width);
    };
  }

  advance(ms: number): void {
    // Whole cycles only.
    this.owed += Math.round(ms * CYCLES_PER_MS);
    while (this.owed > 0) {
      const slice = Math.min(this.owed, SLICE * CYCLES_PER_MS);
      const before = this.board.cycle;
      this.board.run(slice);
      // The last instruction may end some cycles late.
      this.owed -= this.board.cycle - before;
      this.frames.at(this.board.cycle);
      if (this.sent.length > 0) {
        const bytes = Uint8Array.from(this.sent);
        this.sent = [];
        this.onBytes(bytes);
      }
      this.waits.at(this.board.cycle);
    }
  }

  async write(bytes: Uint8Array): Promise<void> {
    this.board.send(bytes);
  }

  async reset(): Promise<void> {
    this.board.reset('external');
  }

  supply(volts: number): void {
    this.board.supply(volts);
  }

  contact(pin: number, isClosed: boolean): void {
    this.board.contact(pin, isClosed);
  }

  wait(ms: number): Promise<void> {
    return this.waits.until(this.board.cycle + ms * CYCLES_PER_MS);
  }

  async close(): Promise<void> {}
}
