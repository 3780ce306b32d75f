// The gait editor: a circle stands for the cycle, and a bar on it for the stance of each leg.
import { kept } from '../kept';
import { type Bars, type Description, type Four, Robot } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { type Edited, FasterView } from './faster';
import { make, tableRow } from './make';
import { numberInput, putNumber, type Range } from './number';
import { isShown } from './rooms';
import { TrialView } from './trial';
import type { Writer } from './writer';

const LEGS = ['LF', 'RF', 'RH', 'LH'] as const;
/** The index of the leg on the other side, for each leg. */
const OPPOSITE = [1, 0, 3, 2] as const;
/** Radii of the four legs' rings, and width of a bar, in units of the picture. */
const RINGS = [104, 82, 60, 38] as const;
const BAR_WIDTH = 16;
/** Length of a leg's bar in a gait whose legs hold, as a share of the cycle. */
const HELD_SHARE = 0.25;
const SVG = 'http://www.w3.org/2000/svg';

type Plain = 'period' | 'duty' | 'amplitude';

/** Ranges of the numbers, as in robot.toml. */
const NUMBERS: Record<Plain, Range> = {
  period: { min: 0.1, max: 10, step: 0.01 },
  duty: { min: 0.05, max: 0.95, step: 0.005 },
  amplitude: { min: 0.5, max: 60, step: 0.1 },
};
/** Ranges of the numbers of each leg. */
const LEG_NUMBERS = { start: { min: 0, max: 1, step: 0.005 }, gain: { min: -2, max: 2, step: 0.05 } };

const round = (value: number, step: number) => Number((Math.round(value / step) * step).toFixed(4));
const wrapPhase = (phase: number) => ((phase % 1) + 1) % 1;

export class GaitsView {
  private readonly panel = element<HTMLDetailsElement>('gait-editor');
  private readonly from = element<HTMLSelectElement>('gait-from');
  private readonly name = element<HTMLInputElement>('gait-name');
  private readonly kindList = element<HTMLSelectElement>('gait-kind');
  private readonly circle = element<HTMLElement>('gait-circle') as unknown as SVGSVGElement;
  private readonly start: HTMLInputElement[] = [];
  private readonly gain: HTMLInputElement[] = [];
  private readonly bars: SVGPathElement[] = [];
  private readonly ends: SVGCircleElement[] = [];
  private readonly trial: TrialView;
  private readonly faster: FasterView;
  private gait: Bars | null = kept.gait();
  private toml = '';

  constructor(
    module: WebAssembly.Module,
    private readonly session: () => Session,
    ask: (line: string) => Promise<unknown>,
    writer: Writer,
    compare: Edited['compare'],
  ) {
    this.trial = new TrialView(module, session, ask, writer, { prefix: 'gait', made: () => this.gait, change: (key, value) => this.change({ [key]: value }) });
    this.faster = new FasterView(session, { gait: () => this.gait, setGait: (gait) => this.change(gait), compare });
    this.panel.addEventListener('toggle', () => this.showRobot());
    this.from.addEventListener('change', () => this.choose());
    this.name.addEventListener('input', () => this.change({ name: this.name.value.trim().replaceAll(' ', '-') }));
    this.kindList.addEventListener('change', () => this.change({ held: this.kindList.value === 'held' }));
    for (const key of Object.keys(NUMBERS) as Plain[]) {
      numberInput(element(`gait-${key}`), NUMBERS[key], (value) => value !== null && this.change({ [key]: value }));
    }
    LEGS.forEach((_, leg) => this.addLeg(leg));
    element('gait-mirror').addEventListener('click', () => this.mirror());
    element('gait-turn-round').addEventListener('click', () => this.gait && this.change(Robot.reversed(this.gait)));
  }

  /** Shows the session's robot if the panel is open; an edited gait stays. */
  showRobot(): void {
    this.faster.follow();
    if (!isShown(this.panel)) return;
    const { description, toml } = this.session();
    if (toml === this.toml) return;
    this.toml = toml;
    this.fill(description);
    if (!this.gait || this.from.value === '') return this.choose();
    this.show();
    this.trial.predict();
  }

  private fill({ gaits }: Description): void {
    const chosen = this.from.value;
    const { robot } = this.session();
    const barGaits = gaits.flatMap(({ name }, number) => (robot.bars(number) ? [{ name, number }] : []));
    this.from.replaceChildren(...barGaits.map(({ name, number }) => new Option(name, String(number))));
    if (barGaits.some(({ number }) => String(number) === chosen)) this.from.value = chosen;
  }

  /** Starts to edit the chosen gait of the robot. */
  private choose(): void {
    const bars = this.from.value === '' ? null : this.session().robot.bars(Number(this.from.value));
    if (!bars) return this.trial.say('This robot has no gait of four bars to start from.');
    this.gait = { ...bars, name: this.name.value || 'mine' };
    this.show();
    this.trial.predict();
  }

  private change(changes: Partial<Bars>): void {
    if (!this.gait) return;
    this.gait = { ...this.gait, ...changes };
    kept.putGait(this.gait);
    this.show();
    this.trial.predict();
  }

  private setLeg(key: 'start' | 'gain', leg: number, value: number): void {
    if (!this.gait) return;
    const values = [...this.gait[key]] as Four<number>;
    values[leg] = value;
    this.change({ [key]: values });
  }

  private mirror(): void {
    if (!this.gait) return;
    const { start, gain } = this.gait;
    const swapSides = (values: Four<number>) => OPPOSITE.map((leg) => values[leg]) as Four<number>;
    this.change({ start: swapSides(start), gain: swapSides(gain) });
  }

  /** Makes the bar, its handle and the two numbers of a leg. */
  private addLeg(leg: number): void {
    const bar = this.circle.appendChild(document.createElementNS(SVG, 'path'));
    const end = this.circle.appendChild(document.createElementNS(SVG, 'circle'));
    bar.classList.add('bar', `a${leg + 1}`);
    end.classList.add('end', `a${leg + 1}`);
    end.setAttribute('r', '6');
    this.bars.push(bar);
    this.ends.push(end);
    this.drag(bar, (cycles, firstGait) => this.setLeg('start', leg, round(wrapPhase((firstGait.start[leg] ?? 0) + cycles), 0.005)));
    this.drag(end, (cycles, firstGait) => this.change({ duty: round(Math.min(0.95, Math.max(0.05, firstGait.duty + cycles)), 0.005) }));
    const row = element('gait-legs').appendChild(tableRow([LEGS[leg] ?? '']));
    for (const [key, label, list] of [['start', 'starts at', this.start], ['gain', 'share', this.gain]] as const) {
      const input = make('input', { ariaLabel: `${LEGS[leg]} ${label}` });
      row.append(make('td', {}, input));
      numberInput(input, LEG_NUMBERS[key], (value) => value !== null && this.setLeg(key, leg, value));
      list.push(input);
    }
  }

  /**
   * Calls `move` with the angle by which the pointer has dragged the mark, in cycles, and the gait at the beginning
   * of the drag.
   */
  private drag(mark: SVGElement, move: (cycles: number, firstGait: Bars) => void): void {
    let lastPhase = 0;
    let draggedCycles = 0;
    let firstGait: Bars | null = null;
    const phaseOf = ({ clientX, clientY }: PointerEvent) => {
      const { left, top, width, height } = this.circle.getBoundingClientRect();
      return Math.atan2(clientX - left - width / 2, top + height / 2 - clientY) / (2 * Math.PI);
    };
    mark.addEventListener('pointerdown', (event) => {
      mark.setPointerCapture(event.pointerId);
      [lastPhase, draggedCycles, firstGait] = [phaseOf(event), 0, this.gait];
    });
    mark.addEventListener('pointermove', (event) => {
      if (!firstGait || !mark.hasPointerCapture(event.pointerId)) return;
      const currentPhase = phaseOf(event);
      // The shorter direction.
      draggedCycles += wrapPhase(currentPhase - lastPhase + 0.5) - 0.5;
      lastPhase = currentPhase;
      move(draggedCycles, firstGait);
    });
    for (const eventName of ['pointerup', 'pointercancel']) mark.addEventListener(eventName, () => (firstGait = null));
  }

  private show(): void {
    const { gait } = this;
    if (!gait) return;
    const put = (input: HTMLInputElement, value: number) => putNumber(input, round(value, 0.001));
    for (const key of Object.keys(NUMBERS) as Plain[]) put(element(`gait-${key}`), gait[key]);
    element<HTMLInputElement>('gait-duty').disabled = gait.held;
    if (document.activeElement !== this.name) this.name.value = gait.name;
    this.kindList.value = gait.held ? 'held' : 'wave';
    const share = gait.held ? HELD_SHARE : gait.duty;
    LEGS.forEach((_, leg) => {
      const [start, radius] = [gait.start[leg] ?? 0, RINGS[leg] ?? 0];
      const [startInput, gainInput] = [this.start[leg], this.gain[leg]];
      if (startInput && gainInput) {
        put(startInput, start);
        put(gainInput, gait.gain[leg] ?? 1);
      }
      this.bars[leg]?.setAttribute('d', arc(radius, start, share));
      // A negative gain: the foot pushes the robot backward.
      this.bars[leg]?.classList.toggle('against', (gait.gain[leg] ?? 1) < 0);
      const [x, y] = ringPoint(radius, start + share);
      this.ends[leg]?.setAttribute('cx', String(x));
      this.ends[leg]?.setAttribute('cy', String(y));
      const handle = this.ends[leg];
      if (handle) handle.style.display = gait.held ? 'none' : '';
    });
  }
}

/** Returns the point of a ring at a phase; phase 0 is at the top, and phases increase clockwise. */
function ringPoint(radius: number, phase: number): [number, number] {
  const angle = 2 * Math.PI * phase;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

function arc(radius: number, start: number, share: number): string {
  const half = BAR_WIDTH / 2;
  const [inner, outer] = [radius - half, radius + half];
  const largeFlag = share > 0.5 ? 1 : 0;
  const [a, b] = [ringPoint(outer, start), ringPoint(outer, start + share)];
  const [c, d] = [ringPoint(inner, start + share), ringPoint(inner, start)];
  const arcTo = (r: number, sweep: number, [x, y]: [number, number]) => `A ${r} ${r} 0 ${largeFlag} ${sweep} ${x} ${y}`;
  return `M ${a[0]} ${a[1]} ${arcTo(outer, 1, b)} L ${c[0]} ${c[1]} ${arcTo(inner, 0, d)} Z`;
}
