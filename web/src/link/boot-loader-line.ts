// The serial line to a board's boot loader. The WebAssembly module for boards implements the protocol, in Rust.
import type { SerialLine } from '../../generated/board';
import { BAUD_RATE, type Link } from './link';

export class BootLoaderLine implements SerialLine {
  private receivedBytes: number[] = [];
  /** Called when bytes arrive. */
  private onArrival: () => void = () => {};
  private baud = BAUD_RATE;

  constructor(private readonly link: Link) {
    link.onBytes = (bytes) => {
      this.receivedBytes.push(...bytes);
      this.onArrival();
    };
  }

  async reset(baud: number): Promise<void> {
    this.baud = baud;
    await this.link.reset(baud);
  }

  write(bytes: Uint8Array): Promise<void> {
    return this.link.write(bytes);
  }

  async read(count: number, timeoutMs: number): Promise<Uint8Array> {
    if (this.receivedBytes.length < count) {
      const completion = new Promise<void>((resolve) => (this.onArrival = () => this.receivedBytes.length >= count && resolve()));
      await Promise.race([this.link.wait(timeoutMs), completion]);
    }
    return Uint8Array.from(this.receivedBytes.splice(0, count));
  }

  async discard(durationMs: number): Promise<void> {
    await this.link.wait(durationMs);
    this.receivedBytes = [];
  }

  /**
   * Sets the link to the firmware's baud rate again. If the boot loader used another rate, this resets the board and
   * drops the bytes received at that rate, because the firmware did not send at it.
   */
  async restoreBaud(): Promise<void> {
    if (this.baud === BAUD_RATE) return;
    this.receivedBytes = [];
    await this.link.reset(BAUD_RATE).catch(() => {});
  }

  /** Takes the received bytes that the boot loader's protocol did not read: a started program may have sent them. */
  takeUnreadBytes(): Uint8Array {
    return Uint8Array.from(this.receivedBytes.splice(0));
  }
}
