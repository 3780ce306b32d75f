// The panel in which a gesture is drawn: the end point of head or tail follows a closed line.
import type { DrawnGait, End, ReachArea } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { numberInput, putNumber, type Range } from './number';
import { isShown } from './rooms';
import { TrialView } from './trial';
import type { Writer } from './writer';

const SVG = 'http://www.w3.org/2000/svg';
/** Least distance of two recorded points, mm. */
const LEAST_DISTANCE = 0.3;
/** Least number of points of a line; fewer points are a tap. */
const LEAST_POINTS = 8;
/** Number of points of a predefined line. */
const POINTS = 96;
/** Margin around the picture, mm. */
const MARGIN = 4;

type Point = [number, number];

/**
 * Predefined lines: points relative to the neutral point, by an angle of 0 to 2π, in tenths of its distance from the
 * base.
 */
const SHAPES: Record<string, (turn: number) => Point> = {
  circle: (turn) => [Math.sin(turn), Math.cos(turn) - 1],
  eight: (turn) => [1.4 * Math.sin(turn), 0.6 * Math.sin(2 * turn)],
  side: (turn) => [1.4 * Math.sin(turn), 0],
  nod: (turn) => [0, Math.sin(turn)],
};

type Plain = 'period' | 'size' | 'terms';
const NUMBERS: Record<Plain, Range> = {
  period: { min: 0.2, max: 20, step: 0.1 },
  size: { min: 5, max: 200, step: 1 },
  terms: { min: 1, max: 16, step: 1 },
};

export class PathView {
  private readonly panel = element<HTMLDetailsElement>('path-editor');
  private readonly plane = element<HTMLElement>('path-plane') as unknown as SVGSVGElement;
  private readonly end = element<HTMLSelectElement>('path-end');
  private readonly shape = element<HTMLSelectElement>('path-shape');
  private readonly name = element<HTMLInputElement>('path-name');
  private readonly trial: TrialView;
  private readonly allowed = this.makePart('path', 'allowed');
  private readonly base = this.makePart('path', 'base');
  private readonly line = this.makePart('path', 'line');
  private readonly rounded = this.makePart('path', 'rounded');
  private readonly neutral = this.makePart('circle', 'neutral');
  private drawn: DrawnGait = { name: 'gesture', end: 'head', period: 4, size: 1, terms: 4, points: [] };
  private room: ReachArea | null = null;
  private toml = '';

  constructor(
    module: WebAssembly.Module,
    private readonly session: () => Session,
    ask: (line: string) => Promise<unknown>,
    writer: Writer,
  ) {
    const gaitToTry = () => (this.drawn.points.length === 0 ? null : this.drawn);
    this.trial = new TrialView(module, session, ask, writer, { prefix: 'path', made: gaitToTry, change: (key, value) => key !== 'amplitude' && this.change({ [key]: value }) });
    this.panel.addEventListener('toggle', () => this.showRobot());
    this.end.addEventListener('change', () => {
      this.drawn = { ...this.drawn, end: this.end.value as End };
      this.begin();
    });
    this.shape.addEventListener('change', () => this.begin());
    this.name.addEventListener('input', () => this.change({ name: this.name.value.trim().replaceAll(' ', '-') }));
    for (const key of Object.keys(NUMBERS) as Plain[]) {
      numberInput(element(`path-${key}`), NUMBERS[key], (value) => {
        if (value === null) return;
        this.change({ [key]: key === 'size' ? value / 100 : key === 'terms' ? Math.round(value) : value });
      });
    }
    this.recordLines();
  }

  /** Shows the plane of the session's robot, if the panel is open; a drawn line stays. */
  showRobot(): void {
    if (!isShown(this.panel)) return;
    const { toml } = this.session();
    if (toml === this.toml) return;
    this.toml = toml;
    this.begin(this.drawn.points.length > 0);
  }

  /** Shows the plane of head or tail, as chosen, with the drawn line if `isKept`, else with the chosen shape. */
  private begin(isKept = false): void {
    this.room = this.session().robot.reachArea(this.drawn.end === 'head' ? 0 : 1);
    if (!this.room) return;
    this.drawBackground(this.room);
    const shape = SHAPES[this.shape.value];
    if (!isKept && shape) {
      const [x, y] = this.room.neutral;
      const tenth = Math.hypot(x, y) / 10;
      const points = Array.from({ length: POINTS }, (_, n): Point => {
        const [right, outward] = shape((2 * Math.PI * n) / POINTS);
        return [x + tenth * right, y + tenth * outward];
      });
      this.change({ points, size: 1 });
    } else if (!isKept) this.change({ points: [], size: 1 });
    else this.change({});
  }

  private change(changes: Partial<DrawnGait>): void {
    this.drawn = { ...this.drawn, ...changes };
    this.show();
    this.trial.predict();
  }

  /** Makes an element of the picture. */
  private makePart<K extends 'path' | 'circle'>(tag: K, name: string): SVGElementTagNameMap[K] {
    const node = this.plane.appendChild(document.createElementNS(SVG, tag));
    node.classList.add(name);
    return node;
  }

  /** Converts a point to the picture: outward is up for the head and down for the tail. */
  private pictureOf([x, y]: Point): Point {
    return [x, this.drawn.end === 'head' ? -y : y];
  }

  private pathText(points: Point[], end = 'Z'): string {
    return points.length === 0 ? '' : `M ${points.map((point) => this.pictureOf(point).map((value) => value.toFixed(2)).join(' ')).join(' L ')} ${end}`;
  }

  /** Draws the background: the reachable area, the base and the neutral point. */
  private drawBackground({ from, step, columns, allowed, neutral, shafts }: ReachArea): void {
    const rows = allowed.length / columns;
    const corner = (column: number, row: number): Point => [from[0] + (column - 0.5) * step, from[1] + (row - 0.5) * step];
    const cells: string[] = [];
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        if (!allowed[row * columns + column]) continue;
        let endColumn = column;
        while (endColumn < columns && allowed[row * columns + endColumn]) endColumn += 1;
        cells.push(this.pathText([corner(column, row), corner(endColumn, row), corner(endColumn, row + 1), corner(column, row + 1)]));
        column = endColumn;
      }
    }
    this.allowed.setAttribute('d', cells.join(' '));
    this.base.setAttribute('d', this.pathText(shafts, ''));
    const [x, y] = this.pictureOf(neutral);
    this.neutral.setAttribute('cx', String(x));
    this.neutral.setAttribute('cy', String(y));
    this.neutral.setAttribute('r', '1.5');
    const farY = from[1] + rows * step;
    const [left, width] = [Math.min(from[0], shafts[0][0]) - MARGIN, Math.max(columns * step, shafts[1][0] - shafts[0][0]) + 2 * MARGIN];
    const height = farY + 2 * MARGIN;
    this.plane.setAttribute('viewBox', `${left} ${this.drawn.end === 'head' ? -farY - MARGIN : -MARGIN} ${width} ${height}`);
  }

  private show(): void {
    const { drawn } = this;
    const put = (name: Plain, value: number) => putNumber(element(`path-${name}`), Number(value.toFixed(2)));
    put('period', drawn.period);
    put('size', drawn.size * 100);
    put('terms', drawn.terms);
    if (document.activeElement !== this.name) this.name.value = drawn.name;
    this.end.value = drawn.end;
    this.line.setAttribute('d', this.pathText(drawn.points));
    this.rounded.setAttribute('d', this.pathText((drawn.points.length > 0 && this.session().robot.path(drawn)) || []));
  }

  /** Records lines that the user draws with a finger or a mouse. */
  private recordLines(): void {
    let points: Point[] | null = null;
    const pointOf = ({ clientX, clientY }: PointerEvent): Point | null => {
      const matrix = this.plane.getScreenCTM();
      if (!matrix) return null;
      const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(matrix.inverse());
      return this.pictureOf([x, y]);
    };
    const addPoint = (event: PointerEvent) => {
      const nextPoint = pointOf(event);
      const lastPoint = points?.at(-1);
      if (!points || !nextPoint || (lastPoint && Math.hypot(nextPoint[0] - lastPoint[0], nextPoint[1] - lastPoint[1]) < LEAST_DISTANCE)) return;
      points.push(nextPoint);
      this.line.setAttribute('d', this.pathText(points, ''));
    };
    this.plane.addEventListener('pointerdown', (event) => {
      if (!this.room) return;
      this.plane.setPointerCapture(event.pointerId);
      points = [];
      this.rounded.setAttribute('d', '');
      addPoint(event);
    });
    this.plane.addEventListener('pointermove', addPoint);
    this.plane.addEventListener('pointerup', (event) => {
      addPoint(event);
      const line = points;
      points = null;
      if (!line) return;
      if (line.length < LEAST_POINTS) {
        this.show();
        return this.trial.say('A tap is not a line: hold and draw it.');
      }
      this.shape.value = 'own';
      this.change({ points: line, size: 1 });
    });
    this.plane.addEventListener('pointercancel', () => {
      points = null;
      this.show();
    });
  }
}
