// The link to a simulated UNO. The UNO runs its image cycle by cycle, and only while `advance` is called.
import type { Four } from '../robot';
import { SimulatedBoard, FREQUENCY_HZ } from '../uno/simulated-board';
import { FrameCollector } from '../uno/frame-collector';
import { GONE_MESSAGE, type Link } from './link';

const CYCLES_PER_MS = FREQUENCY_HZ / 1000;
/** Simulated time between two reads of the chip's output, ms. */
const SLICE_MS = 2;

export class UnoLink implements Link {
  readonly kind = 'simulated';
  readonly name = 'simulated UNO';
  onBytes: (bytes: Uint8Array) => void = () => {};
  /** The calls of `wait` whose time has not come yet. */
  private waits: { endCycle: number; resolve: () => void }[] = [];
  private readonly frameCollector: FrameCollector;
  /** Bytes that the board has sent in the current slice. */
  private bytesFromBoard: number[] = [];
  /** Remaining cycles to run; negative if the chip has overrun its time. */
  private cyclesToRun = 0;
  private isClosed = false;

  /**
   * `pins` are the Arduino numbers of the pins of servos A1 to A4. `onFrame` receives the pulse width of each servo in
   * cycles, 0 for none. `onPulse` receives the Arduino number of a pulse's pin, the cycle of its rising edge, and its
   * width in cycles.
   */
  constructor(
    readonly board: SimulatedBoard,
    pins: number[],
    onFrame: (widths: Four<number>) => void,
    onPulse: (pin: number, riseCycle: number, width: number) => void,
  ) {
    this.frameCollector = new FrameCollector(pins, onFrame);
    board.onByte = (byte) => this.bytesFromBoard.push(byte);
    board.onPulse = (pin, riseCycle, width) => {
      onPulse(pin, riseCycle, width);
      this.frameCollector.add(pin, riseCycle, width);
    };
  }

  /** Runs the board for `ms` of simulated time, and forwards its bytes and pulses. */
  advance(ms: number): void {
    // The chip runs whole cycles only.
    this.cyclesToRun += Math.round(ms * CYCLES_PER_MS);
    while (this.cyclesToRun > 0) {
      const sliceCycles = Math.min(this.cyclesToRun, SLICE_MS * CYCLES_PER_MS);
      const startCycle = this.board.cycle;
      this.board.run(sliceCycles);
      // The last instruction may overrun the slice.
      this.cyclesToRun -= this.board.cycle - startCycle;
      this.frameCollector.advanceTo(this.board.cycle);
      if (this.bytesFromBoard.length > 0) {
        const bytes = Uint8Array.from(this.bytesFromBoard);
        this.bytesFromBoard = [];
        this.onBytes(bytes);
      }
      this.endWaits(this.board.cycle);
    }
  }

  /** Resolves the calls of `wait` whose time has come at `cycle`. */
  private endWaits(cycle: number): void {
    const ended = this.waits.filter(({ endCycle }) => endCycle <= cycle);
    if (ended.length === 0) return;
    this.waits = this.waits.filter(({ endCycle }) => endCycle > cycle);
    for (const { resolve } of ended) resolve();
  }

  async write(bytes: Uint8Array): Promise<void> {
    if (this.isClosed) throw new Error(GONE_MESSAGE);
    this.board.send(bytes);
  }

  /** Resets the board with its reset pin. */
  async reset(): Promise<void> {
    this.board.reset('external');
  }

  wait(ms: number): Promise<void> {
    if (this.isClosed) return Promise.resolve();
    const endCycle = this.board.cycle + ms * CYCLES_PER_MS;
    return new Promise((resolve) => this.waits.push({ endCycle, resolve }));
  }

  /** Ends all calls of `wait`, because the board's time stops. */
  async close(): Promise<void> {
    this.isClosed = true;
    this.endWaits(Infinity);
  }
}
