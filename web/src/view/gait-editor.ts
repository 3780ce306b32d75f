// The gait editor: a circle represents the cycle. A leg's bar represents its stance, or in a held gait its turn to
// swing.
import { browserStorage } from '../browser-storage';
import { type Bars, type Description, type Four, Robot } from '../robot';
import type { Session } from '../session';
import { type GaitEditor, FasterView } from './faster';
import { element, make, makeSvg, replaceOptions, setAttributes, tableRow } from './elements';
import { setUpNumberInput, setNumber } from './number-input';
import { followShownRobot } from './rooms';
import { TrialView } from './trial';
import type { BoardWriter } from './writer';

const LEGS = ['LF', 'RF', 'RH', 'LH'] as const;
/** The index of the leg on the other side, for each leg. */
const MIRRORED_LEGS = [1, 0, 3, 2] as const;
/** Radius of each leg's ring, in units of the SVG. */
const RING_RADII = [104, 82, 60, 38] as const;
/** Width of a bar, in units of the SVG. */
const BAR_WIDTH = 16;
/** Fraction of the circle that a bar covers in a held gait, whose bars show only the order of the swings. */
const HELD_BAR_FRACTION = 0.25;

/** The keys of a gait's numbers that have an input. In index.html, each input has a range that robot.toml allows. */
const GAIT_NUMBERS = ['period', 'duty', 'amplitude'] as const;
/** The ranges that robot.toml allows for a leg's numbers, and the steps of their inputs. */
const LEG_NUMBER_RANGES = { start: { min: '0', max: '1', step: '0.005' }, gain: { min: '-4', max: '4', step: '0.05' } };

/** Rounds a value to a multiple of `step`. */
const roundToMultiple = (value: number, step: number) => Number((Math.round(value / step) * step).toFixed(4));
/** Wraps a phase to the range from 0 to less than 1. */
const wrapPhase = (phase: number) => ((phase % 1) + 1) % 1;

export class GaitEditorView {
  private readonly templateList = element<HTMLSelectElement>('gait-from');
  private readonly nameInput = element<HTMLInputElement>('gait-name');
  private readonly kindList = element<HTMLSelectElement>('gait-kind');
  private readonly circle = element<HTMLElement>('gait-circle') as unknown as SVGSVGElement;
  private readonly legInputs: Record<'start' | 'gain', HTMLInputElement[]> = { start: [], gain: [] };
  private readonly bars: SVGPathElement[] = [];
  private readonly handles: SVGCircleElement[] = [];
  private readonly trial: TrialView;
  private readonly faster: FasterView;
  /** The edited gait; null before the first gait. */
  private gait: Bars | null = browserStorage.getGait();

  constructor(
    private readonly session: Session,
    writer: BoardWriter,
    compare: GaitEditor['compare'],
  ) {
    this.trial = new TrialView(session, writer, { prefix: 'gait', editedGait: () => this.gait, change: (key, value) => this.changeGait({ [key]: value }) });
    this.faster = new FasterView(session, { gait: () => this.gait, setGait: (gait) => this.changeGait(gait), compare });
    session.robot.follow(() => this.faster.discardIfRobotChanged());
    followShownRobot(element<HTMLDetailsElement>('gait-editor'), session, (description) => this.showRobot(description));
    this.templateList.addEventListener('change', () => this.editTemplate());
    this.nameInput.addEventListener('input', () => this.changeGait({ name: this.nameInput.value.trim().replaceAll(' ', '-') }));
    this.kindList.addEventListener('change', () => this.changeGait({ held: this.kindList.value === 'held' }));
    for (const key of GAIT_NUMBERS) setUpNumberInput(element(`gait-${key}`), (value) => value !== null && this.changeGait({ [key]: value }));
    LEGS.forEach((_, leg) => this.addLeg(leg));
    element('gait-mirror').addEventListener('click', () => this.mirror());
    element('gait-turn-round').addEventListener('click', () => this.gait && this.changeGait(Robot.reversed(this.gait)));
  }

  /** Shows another robot; an edited gait stays. */
  private showRobot({ gaits }: Description): void {
    const { wasm } = this.session.robot;
    const options = gaits.flatMap(({ name }, index) => (wasm.bars(index) ? [new Option(name, String(index))] : []));
    replaceOptions(this.templateList, options);
    if (!this.gait || this.templateList.value === '') return this.editTemplate();
    this.showGait();
  }

  /** Starts editing a copy of the robot's gait that the user chose as a template. */
  private editTemplate(): void {
    const bars = this.templateList.value === '' ? null : this.session.robot.wasm.bars(Number(this.templateList.value));
    if (!bars) return this.trial.setMessage('This robot has no gait of four bars to start from.');
    this.gait = { ...bars, name: this.nameInput.value || 'mine' };
    this.showGait();
  }

  private changeGait(changes: Partial<Bars>): void {
    if (!this.gait) return;
    this.gait = { ...this.gait, ...changes };
    browserStorage.putGait(this.gait);
    this.showGait();
  }

  private setLegValue(key: 'start' | 'gain', leg: number, value: number): void {
    if (this.gait) this.changeGait({ [key]: this.gait[key].with(leg, value) });
  }

  /** Swaps the left and the right legs. */
  private mirror(): void {
    if (!this.gait) return;
    const { start, gain } = this.gait;
    const swapSides = (values: Four<number>) => MIRRORED_LEGS.map((leg) => values[leg]) as Four<number>;
    this.changeGait({ start: swapSides(start), gain: swapSides(gain) });
  }

  /** Adds a leg's bar, its handle and the leg's two number inputs. */
  private addLeg(leg: number): void {
    const bar = this.circle.appendChild(makeSvg('path', { class: `bar a${leg + 1}` }));
    const handle = this.circle.appendChild(makeSvg('circle', { class: `end a${leg + 1}`, r: 6 }));
    this.bars.push(bar);
    this.handles.push(handle);
    this.addDragHandler(bar, (cycles, startGait) => this.setLegValue('start', leg, roundToMultiple(wrapPhase((startGait.start[leg] ?? 0) + cycles), 0.005)));
    const { min, max } = element<HTMLInputElement>('gait-duty');
    const clampDuty = (duty: number) => Math.min(Number(max), Math.max(Number(min), duty));
    this.addDragHandler(handle, (cycles, startGait) => this.changeGait({ duty: roundToMultiple(clampDuty(startGait.duty + cycles), 0.005) }));
    const row = element('gait-legs').appendChild(tableRow([LEGS[leg] ?? '']));
    for (const [key, label] of [['start', 'starts at'], ['gain', 'gain']] as const) {
      const input = make('input', { type: 'number', required: true, ...LEG_NUMBER_RANGES[key], ariaLabel: `${LEGS[leg]} ${label}` });
      row.append(make('td', {}, input));
      setUpNumberInput(input, (value) => value !== null && this.setLegValue(key, leg, value));
      this.legInputs[key].push(input);
    }
  }

  /** Calls `onDrag` during a drag of `mark`, with the angle of the drag in cycles and the gait at the drag's start. */
  private addDragHandler(mark: SVGElement, onDrag: (cycles: number, startGait: Bars) => void): void {
    let lastPhase = 0;
    let draggedCycles = 0;
    let startGait: Bars | null = null;
    const computePhase = ({ clientX, clientY }: PointerEvent) => {
      const { left, top, width, height } = this.circle.getBoundingClientRect();
      return Math.atan2(clientX - left - width / 2, top + height / 2 - clientY) / (2 * Math.PI);
    };
    mark.addEventListener('pointerdown', (event) => {
      mark.setPointerCapture(event.pointerId);
      [lastPhase, draggedCycles, startGait] = [computePhase(event), 0, this.gait];
    });
    mark.addEventListener('pointermove', (event) => {
      if (!startGait || !mark.hasPointerCapture(event.pointerId)) return;
      const currentPhase = computePhase(event);
      // Assumes that the pointer moves less than half a circle between two events.
      draggedCycles += wrapPhase(currentPhase - lastPhase + 0.5) - 0.5;
      lastPhase = currentPhase;
      onDrag(draggedCycles, startGait);
    });
    for (const eventName of ['pointerup', 'pointercancel']) mark.addEventListener(eventName, () => (startGait = null));
  }

  /** Shows the edited gait and requests its trial. */
  private showGait(): void {
    const { gait } = this;
    if (!gait) return;
    const showNumber = (input: HTMLInputElement, value: number) => setNumber(input, roundToMultiple(value, 0.001));
    for (const key of GAIT_NUMBERS) showNumber(element(`gait-${key}`), gait[key]);
    element<HTMLInputElement>('gait-duty').disabled = gait.held;
    if (document.activeElement !== this.nameInput) this.nameInput.value = gait.name;
    this.kindList.value = gait.held ? 'held' : 'wave';
    const fraction = gait.held ? HELD_BAR_FRACTION : gait.duty;
    LEGS.forEach((_, leg) => {
      const [start, radius] = [gait.start[leg] ?? 0, RING_RADII[leg] ?? 0];
      showNumber(this.legInputs.start[leg], start);
      showNumber(this.legInputs.gain[leg], gait.gain[leg] ?? 1);
      this.bars[leg]?.setAttribute('d', makeSectorPath(radius, start, fraction));
      // A negative gain makes the foot push the robot backward.
      this.bars[leg]?.classList.toggle('against', (gait.gain[leg] ?? 1) < 0);
      const [cx, cy] = locateOnRing(radius, start + fraction);
      setAttributes(this.handles[leg], { cx, cy, display: gait.held ? 'none' : 'inline' });
    });
    this.trial.requestTrial();
  }
}

/** Returns the point of a ring at a phase; phase 0 is at the top, and phases increase clockwise. */
function locateOnRing(radius: number, phase: number): [number, number] {
  const angle = 2 * Math.PI * phase;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

/** Returns the SVG path of a bar, a ring sector that starts at phase `start` and covers `fraction` of the circle. */
function makeSectorPath(radius: number, start: number, fraction: number): string {
  const halfWidth = BAR_WIDTH / 2;
  const [inner, outer] = [radius - halfWidth, radius + halfWidth];
  const largeFlag = fraction > 0.5 ? 1 : 0;
  const [a, b] = [locateOnRing(outer, start), locateOnRing(outer, start + fraction)];
  const [c, d] = [locateOnRing(inner, start + fraction), locateOnRing(inner, start)];
  const formatArc = (r: number, sweep: number, [x, y]: [number, number]) => `A ${r} ${r} 0 ${largeFlag} ${sweep} ${x} ${y}`;
  return `M ${a[0]} ${a[1]} ${formatArc(outer, 1, b)} L ${c[0]} ${c[1]} ${formatArc(inner, 0, d)} Z`;
}
