// The link to the firmware's core, compiled to WebAssembly: for a robot that has no image.
import type { Four, Robot } from '../robot';
import { FREQUENCY } from '../uno/board';
import { type Simulated, Waits } from './link';

const FRAME_MS = 20;

export class CoreLink implements Simulated {
  readonly name = 'core in the page';
  readonly canFlash = false;
  onBytes: (bytes: Uint8Array) => void = () => {};
  onGone: (why: string) => void = () => {};
  private readonly waits = new Waits();
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();
  private line = '';
  private now = 0;
  private owed = 0;
  private volts = 5;

  constructor(
    private readonly robot: Robot,
    private readonly onFrame: (widths: Four<number>, cycle: number) => void,
  ) {
    robot.runCore();
  }

  advance(ms: number): void {
    this.owed += ms;
    while (this.owed >= FRAME_MS) {
      this.owed -= FRAME_MS;
      this.now += FRAME_MS;
      const said = this.robot.coreFrame(this.line, this.volts);
      this.line = '';
      if (said) {
        this.onFrame(said.widths, (this.now * FREQUENCY) / 1000);
        if (said.text !== '') this.onBytes(this.encoder.encode(said.text));
      }
      this.waits.at(this.now);
    }
  }

  async write(bytes: Uint8Array): Promise<void> {
    this.line += this.decoder.decode(bytes);
  }

  async reset(): Promise<void> {
    this.line = '';
    this.robot.runCore();
  }

  supply(volts: number): void {
    this.volts = volts;
  }

  wait(ms: number): Promise<void> {
    return this.waits.until(this.now + ms);
  }

  async close(): Promise<void> {}
}
