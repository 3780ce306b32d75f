// The panel of the servos' pulses: the pulses as on an oscilloscope, and their widths as numbers.
import { effect } from '@preact/signals-core';

import type { Description, Scene } from '../robot';
import type { Session } from '../session';
import { UnoLink } from '../link/uno-link';
import { FREQUENCY_HZ } from '../uno/simulated-board';
import { addPolyline, beginLines, prepareSurface } from './canvas';
import { element, make, setText } from './elements';
import { getPalette, getServoColour } from './palette';
import { isShown } from './rooms';

/** Time span of the scope: three frames, in CPU cycles. */
const SPAN_CYCLES = 0.06 * FREQUENCY_HZ;
/** A longer pause than this means that the servos get no pulses: one frame, in CPU cycles. */
const MAX_PAUSE_CYCLES = 0.02 * FREQUENCY_HZ;
const CYCLES_PER_US = FREQUENCY_HZ / 1e6;

/** A servo's pulse: the CPU cycle of its rising edge, and its width in CPU cycles. */
interface Pulse {
  servo: number;
  riseCycle: number;
  widthCycles: number;
}

/** Returns the name of a pin, such as D3 or A1, from its Arduino number. */
const formatPin = (pin: number) => (pin >= 14 ? `A${pin - 14}` : `D${pin}`);

export class ScopeView {
  private rows: { row: HTMLElement; width: HTMLElement; angle: HTMLElement }[] = [];
  private pins: number[] = [];
  private pulses: Pulse[] = [];
  /** The CPU cycle of the last falling edge of a pulse. */
  private lastFallCycle = 0;
  /** Pulse widths of the latest frame, CPU cycles; 0 for no pulse. */
  frameWidths: readonly number[] = [0, 0, 0, 0];
  /** True for the simulated board, whose pulses are known; a real board reports only poses. */
  private hasPulses = true;

  constructor(private readonly session: Session) {
    session.robot.follow((description) => this.showRobot(description));
    effect(() => {
      const { isReal } = session.board; // depends on the link
      this.hasPulses = !isReal;
      element('scope-note').hidden = !isReal;
      this.pulses = [];
      this.lastFallCycle = 0;
      this.frameWidths = [0, 0, 0, 0];
    });
  }

  private showRobot({ servos }: Description): void {
    this.pins = servos.map(({ pin }) => pin);
    this.pulses = [];
    this.rows = servos.map(({ name, pin }, servo) => {
      const swatch = make('span', { className: 'swatch' });
      swatch.style.background = `var(--a${servo + 1})`;
      const [width, angle] = [make('td', {}, '–'), make('td', {}, '–')];
      return { row: make('tr', {}, make('td', {}, swatch, name), make('td', {}, formatPin(pin)), width, angle), width, angle };
    });
    element('widths').replaceChildren(...this.rows.map(({ row }) => row));
  }

  /** Adds a pulse of the pin with this Arduino number; times are CPU cycles. */
  addPulse(pin: number, riseCycle: number, widthCycles: number): void {
    const servo = this.pins.indexOf(pin);
    if (servo < 0) return;
    this.lastFallCycle = riseCycle + widthCycles;
    this.pulses.push({ servo, riseCycle, widthCycles });
    if (this.pulses.length > 64) this.pulses.splice(0, 32);
  }

  /** The simulated board's cycle; 0 for a real board. */
  private get boardCycle(): number {
    const { link } = this.session.board;
    return link instanceof UnoLink ? link.board.cycle : 0;
  }

  /** True if the simulated board sends no pulses. */
  private get isPulseless(): boolean {
    return this.boardCycle - this.lastFallCycle > MAX_PAUSE_CYCLES;
  }

  /** Updates the table; called less often than `draw`, because each change of a text causes a layout. */
  updateNumbers(scene: Scene | null): void {
    if (!isShown(element<HTMLDetailsElement>('pulses'))) return;
    this.rows.forEach(({ width, angle }, servo) => {
      const cycles = this.isPulseless ? 0 : this.frameWidths[servo];
      setText(width, !this.hasPulses ? '–' : cycles ? (cycles / CYCLES_PER_US).toFixed(2) : 'none');
      setText(angle, scene ? `${scene.angles[servo].toFixed(1)}°` : '–');
    });
  }

  /** Draws the pulses; at the right edge is the end of the last pulse, or the present if there are no pulses. */
  draw(): void {
    const surface = prepareSurface(element<HTMLCanvasElement>('scope'));
    if (!surface) return;
    const { context, width, height } = surface;
    const rowHeight = height / 4;
    const currentCycle = this.isPulseless ? this.boardCycle : this.lastFallCycle;
    const toX = (cycle: number) => width * (1 - (currentCycle - cycle) / SPAN_CYCLES);
    for (let servo = 0; servo < 4; servo++) {
      const lowY = (servo + 1) * rowHeight - 3;
      const highY = servo * rowHeight + 5;
      context.strokeStyle = getPalette().grid;
      context.lineWidth = 1;
      context.strokeRect(-1, servo * rowHeight, width + 2, rowHeight);
      if (!this.hasPulses) continue;
      beginLines(context, getServoColour(servo), 2);
      const spans = this.pulses
        .filter((pulse) => pulse.servo === servo)
        .map(({ riseCycle, widthCycles }) => [toX(riseCycle), toX(riseCycle + widthCycles)])
        .filter(([, to]) => to >= 0);
      addPolyline(context, [0, lowY], ...spans.flatMap(([from, to]): [number, number][] => [[from, lowY], [from, highY], [to, highY], [to, lowY]]), [width, lowY]);
      context.stroke();
    }
  }
}
