// The serial line to a board's boot loader. The conversation with it is Rust, in the module of boards.
import type { Line } from '../../generated/board';
import { BAUD, type Link } from './link';

export class BootLine implements Line {
  private received: number[] = [];
  private arrived: () => void = () => {};
  private baud = BAUD;

  constructor(private readonly link: Link) {
    link.onBytes = (bytes) => {
      this.received.push(...bytes);
      this.arrived();
    };
  }

  async reset(baud: number): Promise<void> {
    this.baud = baud;
    await this.link.reset(baud);
  }

  write(bytes: Uint8Array): Promise<void> {
    return this.link.write(bytes);
  }

  async read(count: number, ms: number): Promise<Uint8Array> {
    if (this.received.length < count) {
      const isComplete = new Promise<void>((resolve) => (this.arrived = () => this.received.length >= count && resolve()));
      await Promise.race([this.link.wait(ms), isComplete]);
    }
    return Uint8Array.from(this.received.splice(0, count));
  }

  async discard(ms: number): Promise<void> {
    await this.link.wait(ms);
    this.received = [];
  }

  /** Returns the line to the firmware's baud rate, which resets the board if the boot loader has another one. */
  async end(): Promise<void> {
    if (this.baud !== BAUD) await this.link.reset(BAUD).catch(() => {});
  }
}
