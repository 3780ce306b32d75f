// The four servos' pulses as an oscilloscope shows them, and their widths as numbers.
import type { Description, Scene } from '../robot';
import { FREQUENCY } from '../uno/board';
import { element, surface } from './canvas';
import { make } from './make';
import { palette, servoColour } from './palette';
import { isShown } from './rooms';

/** Time span of the scope, cycles: three frames. */
const SPAN_CYCLES = 0.06 * FREQUENCY;
const CYCLES_PER_US = FREQUENCY / 1e6;

interface Pulse {
  servo: number;
  rise: number;
  width: number;
}

function pinName(pin: number): string {
  return pin >= 14 ? `A${pin - 14}` : `D${pin}`;
}

export class ScopeView {
  private readonly panel = element<HTMLDetailsElement>('pulses');
  private readonly canvas = element<HTMLCanvasElement>('scope');
  private readonly rows: { width: HTMLElement; angle: HTMLElement }[] = [];
  private pins: number[] = [];
  private pulses: Pulse[] = [];
  private readonly note = element('scope-note');
  private widths = [0, 0, 0, 0];
  /** True if pulses are known, on the simulated board: a real board sends only its pose. */
  private hasPulses = true;

  /** Shows another robot. */
  setRobot({ servos }: Description): void {
    this.pins = servos.map(({ pin }) => pin);
    this.pulses = [];
    const body = element('widths');
    body.replaceChildren();
    this.rows.length = 0;
    servos.forEach(({ name, pin }, servo) => {
      const swatch = make('span', { className: 'swatch' });
      swatch.style.background = `var(--a${servo + 1})`;
      const [width, angle] = [make('td', {}, '–'), make('td', {}, '–')];
      body.append(make('tr', {}, make('td', {}, swatch, name), make('td', {}, pinName(pin)), width, angle));
      this.rows.push({ width, angle });
    });
  }

  /** Switches to a simulated or a real board. */
  link(isReal: boolean): void {
    this.hasPulses = !isReal;
    this.note.hidden = !isReal;
    this.pulses = [];
    this.widths = [0, 0, 0, 0];
  }

  /** Adds a pulse of a pin, by its Arduino number; `rise` and `width` are in cycles. */
  pulse(pin: number, rise: number, width: number): void {
    const servo = this.pins.indexOf(pin);
    if (servo < 0) return;
    this.pulses.push({ servo, rise, width });
    if (this.pulses.length > 64) this.pulses.splice(0, 32);
  }

  /** Sets the pulse widths of the latest frame, cycles; 0 for no pulse. */
  frame(widths: readonly number[]): void {
    this.widths = [...widths];
  }

  /** Updates the numbers in the table, for which the browser must lay out the page again. */
  write(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.rows.forEach(({ width, angle }, servo) => {
      const cycles = this.widths[servo];
      const text = !this.hasPulses ? '–' : cycles ? (cycles / CYCLES_PER_US).toFixed(2) : 'none';
      if (width.textContent !== text) width.textContent = text;
      const degrees = scene ? `${scene.angles[servo].toFixed(1)}°` : '–';
      if (angle.textContent !== degrees) angle.textContent = degrees;
    });
  }

  draw(currentCycle: number): void {
    const area = surface(this.canvas);
    if (!area) return;
    const { pen, width, height } = area;
    const rowHeight = height / 4;
    const xOf = (cycle: number) => width * (1 - (currentCycle - cycle) / SPAN_CYCLES);
    for (let servo = 0; servo < 4; servo++) {
      const lowY = (servo + 1) * rowHeight - 3;
      const highY = servo * rowHeight + 5;
      pen.strokeStyle = palette().grid;
      pen.lineWidth = 1;
      pen.strokeRect(-1, servo * rowHeight, width + 2, rowHeight);
      if (!this.hasPulses) continue;
      pen.strokeStyle = servoColour(servo);
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(0, lowY);
      for (const pulse of this.pulses) {
        if (pulse.servo !== servo || xOf(pulse.rise + pulse.width) < 0) continue;
        const [from, to] = [xOf(pulse.rise), xOf(pulse.rise + pulse.width)];
        pen.lineTo(from, lowY);
        pen.lineTo(from, highY);
        pen.lineTo(to, highY);
        pen.lineTo(to, lowY);
      }
      pen.lineTo(width, lowY);
      pen.stroke();
    }
  }
}
