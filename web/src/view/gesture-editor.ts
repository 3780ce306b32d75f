// The panel in which the user draws a gesture: a closed line that the end point of the head or the tail follows.
import type { DrawnGait, End, Workspace } from '../robot';
import type { Session } from '../session';
import { element, makeSvg, setAttributes, toPicture } from './elements';
import { setUpNumberInput, setNumber } from './number-input';
import { followShownRobot } from './rooms';
import { TrialView } from './trial';
import type { BoardWriter } from './writer';

/** Smallest distance between two consecutive recorded points. */
const MIN_POINT_DISTANCE_MM = 0.3;
/** Smallest number of points of a line; fewer points count as a tap. */
const MIN_POINT_COUNT = 8;
/** Number of points of a predefined shape. */
const SHAPE_POINT_COUNT = 96;
/** Margin around the workspace in the picture. */
const MARGIN_MM = 4;

type Point = [number, number];

/**
 * The predefined shapes: each function returns the shape's point at an angle of 0 to 2π, relative to the neutral point.
 * The unit is a tenth of the distance between the base and the neutral point.
 */
const SHAPES: Record<string, ((angle: number) => Point) | undefined> = {
  circle: (angle) => [Math.sin(angle), Math.cos(angle) - 1],
  eight: (angle) => [1.4 * Math.sin(angle), 0.6 * Math.sin(2 * angle)],
  side: (angle) => [1.4 * Math.sin(angle), 0],
  nod: (angle) => [0, Math.sin(angle)],
};

/**
 * The numeric properties of a gesture that have an input: the period in s, the size in percent, and the number of terms
 * of the Fourier series.
 */
const NUMERIC_KEYS = ['period', 'size', 'terms'] as const;

export class GestureEditorView {
  private readonly plane = element<HTMLElement>('gesture-plane') as unknown as SVGSVGElement;
  private readonly endList = element<HTMLSelectElement>('gesture-end');
  private readonly shapeList = element<HTMLSelectElement>('gesture-shape');
  private readonly nameInput = element<HTMLInputElement>('gesture-name');
  private readonly trial: TrialView;
  private readonly workspacePath = this.plane.appendChild(makeSvg('path', { class: 'workspace' }));
  private readonly baseLine = this.plane.appendChild(makeSvg('path', { class: 'base' }));
  private readonly drawnLine = this.plane.appendChild(makeSvg('path', { class: 'line' }));
  private readonly smoothedPath = this.plane.appendChild(makeSvg('path', { class: 'smoothed' }));
  private readonly neutralDot = this.plane.appendChild(makeSvg('circle', { class: 'neutral', r: 1.5 }));
  /** The edited gesture; it has no points until a line is drawn or a shape is chosen. */
  private gesture: DrawnGait = { name: 'gesture', end: 'head', period: 4, size: 1, terms: 4, points: [] };
  /** The workspace of the end point; null until the panel is opened, or if there is none. */
  private workspace: Workspace | null = null;

  constructor(
    private readonly session: Session,
    writer: BoardWriter,
  ) {
    const editedGait = () => (this.gesture.points.length === 0 ? null : this.gesture);
    this.trial = new TrialView(session, writer, { prefix: 'gesture', editedGait, change: (key, value) => key !== 'amplitude' && this.changeGesture({ [key]: value }) });
    this.endList.addEventListener('change', () => {
      this.gesture = { ...this.gesture, end: this.endList.value as End };
      this.showPlane();
    });
    this.shapeList.addEventListener('change', () => this.showPlane());
    this.nameInput.addEventListener('input', () => this.changeGesture({ name: this.nameInput.value.trim().replaceAll(' ', '-') }));
    for (const key of NUMERIC_KEYS) {
      setUpNumberInput(element(`gesture-${key}`), (value) => {
        if (value === null) return;
        this.changeGesture({ [key]: key === 'size' ? value / 100 : key === 'terms' ? Math.round(value) : value });
      });
    }
    this.recordLines();
    // A drawn line stays when the robot changes.
    followShownRobot(element<HTMLDetailsElement>('gesture-editor'), session, () => this.showPlane(this.gesture.points.length > 0));
  }

  /** Shows the plane of the chosen end with the current line if `keepsLine`, else with the chosen shape. */
  private showPlane(keepsLine = false): void {
    this.workspace = this.session.robot.wasm.workspace(this.gesture.end === 'head' ? 0 : 1);
    if (!this.workspace) return;
    this.drawBackground(this.workspace);
    if (keepsLine) return this.changeGesture({});
    const pointAt = SHAPES[this.shapeList.value];
    const [x, y] = this.workspace.neutral;
    const tenth = Math.hypot(x, y) / 10;
    const angles = Array.from({ length: SHAPE_POINT_COUNT }, (_, n) => (2 * Math.PI * n) / SHAPE_POINT_COUNT);
    const points = pointAt ? angles.map(pointAt).map(([right, outward]): Point => [x + tenth * right, y + tenth * outward]) : [];
    this.changeGesture({ points, size: 1 });
  }

  private changeGesture(changes: Partial<DrawnGait>): void {
    this.gesture = { ...this.gesture, ...changes };
    this.showGesture();
    this.trial.requestTrial();
  }

  /** Converts a point from the plane to the picture, or back. Outward is up for the head and down for the tail. */
  private convertPoint([x, y]: Point): Point {
    return [x, this.gesture.end === 'head' ? -y : y];
  }

  /** Returns the SVG path through points, closed by default. */
  private formatPath(points: Point[], suffix = 'Z'): string {
    return points.length === 0 ? '' : `M ${points.map((point) => this.convertPoint(point).map((value) => value.toFixed(2)).join(' ')).join(' L ')} ${suffix}`;
  }

  /** Draws the background: the workspace, the base and the neutral point. */
  private drawBackground({ first_point: [firstX, firstY], spacing, columns, allowed, neutral, shafts }: Workspace): void {
    const rows = allowed.length / columns;
    const corner = (column: number, row: number): Point => [firstX + (column - 0.5) * spacing, firstY + (row - 0.5) * spacing];
    const cells: string[] = [];
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        if (!allowed[row * columns + column]) continue;
        let endColumn = column;
        while (endColumn < columns && allowed[row * columns + endColumn]) endColumn += 1;
        cells.push(this.formatPath([corner(column, row), corner(endColumn, row), corner(endColumn, row + 1), corner(column, row + 1)]));
        column = endColumn;
      }
    }
    this.workspacePath.setAttribute('d', cells.join(' '));
    this.baseLine.setAttribute('d', this.formatPath(shafts, ''));
    const [x, y] = this.convertPoint(neutral);
    setAttributes(this.neutralDot, { cx: x, cy: y });
    const farY = firstY + rows * spacing;
    const [left, width] = [Math.min(firstX, shafts[0][0]) - MARGIN_MM, Math.max(columns * spacing, shafts[1][0] - shafts[0][0]) + 2 * MARGIN_MM];
    const height = farY + 2 * MARGIN_MM;
    this.plane.setAttribute('viewBox', `${left} ${this.gesture.end === 'head' ? -farY - MARGIN_MM : -MARGIN_MM} ${width} ${height}`);
  }

  private showGesture(): void {
    const { gesture } = this;
    const put = (key: (typeof NUMERIC_KEYS)[number], value: number) => setNumber(element(`gesture-${key}`), Number(value.toFixed(2)));
    put('period', gesture.period);
    put('size', gesture.size * 100);
    put('terms', gesture.terms);
    if (document.activeElement !== this.nameInput) this.nameInput.value = gesture.name;
    this.endList.value = gesture.end;
    this.drawnLine.setAttribute('d', this.formatPath(gesture.points));
    this.smoothedPath.setAttribute('d', this.formatPath((gesture.points.length > 0 && this.session.robot.wasm.smoothedPath(gesture)) || []));
  }

  /** Records the lines that the user draws with a finger or a mouse. */
  private recordLines(): void {
    let points: Point[] | null = null;
    const addPoint = (event: PointerEvent) => {
      const position = toPicture(this.plane, event);
      if (!points || !position) return;
      const nextPoint = this.convertPoint([position.x, position.y]);
      const lastPoint = points.at(-1);
      if (lastPoint && Math.hypot(nextPoint[0] - lastPoint[0], nextPoint[1] - lastPoint[1]) < MIN_POINT_DISTANCE_MM) return;
      points.push(nextPoint);
      this.drawnLine.setAttribute('d', this.formatPath(points, ''));
    };
    this.plane.addEventListener('pointerdown', (event) => {
      if (!this.workspace) return;
      this.plane.setPointerCapture(event.pointerId);
      points = [];
      this.smoothedPath.setAttribute('d', '');
      addPoint(event);
    });
    this.plane.addEventListener('pointermove', addPoint);
    this.plane.addEventListener('pointerup', (event) => {
      addPoint(event);
      const line = points;
      points = null;
      if (!line) return;
      if (line.length < MIN_POINT_COUNT) {
        this.showGesture();
        return this.trial.setMessage('A tap is not a line: press, hold and draw.');
      }
      this.shapeList.value = 'own';
      this.changeGesture({ points: line, size: 1 });
    });
    this.plane.addEventListener('pointercancel', () => {
      points = null;
      this.showGesture();
    });
  }
}
