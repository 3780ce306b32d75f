// A drawing of the robot whose joints can be dragged, and a slider for one length. Invalid lengths are refused during
// the drag.
import { LatestQuestion } from '../latest';
import type { Edits, Length, Scene, Point } from '../robot';
import { robotHelper } from '../robot-helper';
import type { RobotFunctions } from '../robot-worker';
import type { Session } from '../session';
import { bars, type Joint, joints } from '../sketch/joints';
import { element } from './canvas';
import type { FitView } from './fit';
import { LengthSlider } from './length-slider';
import { isShown } from './rooms';
import { refusalOf, showOffers, words } from './tried-lengths';

type Question = Parameters<RobotFunctions['lengths']>[0];
type Answer = ReturnType<RobotFunctions['lengths']>;

const SVG = 'http://www.w3.org/2000/svg';
/** Movement of the pointer beyond which a press is a drag, CSS pixels. */
const DRAG_THRESHOLD = 3;
/** Margin around the robot, mm. */
const MARGIN = 14;

export class Sketch {
  private readonly panel = element<HTMLDetailsElement>('lengths-panel');
  private readonly picture = element<HTMLElement>('sketch') as unknown as SVGSVGElement;
  private readonly message = element('sketch-said');
  private readonly symmetric = element<HTMLInputElement>('alike');
  private readonly drawnBars = this.picture.appendChild(document.createElementNS(SVG, 'g'));
  private readonly drawnJoints = this.picture.appendChild(document.createElementNS(SVG, 'g'));
  private sketches: LatestQuestion<Question, Answer> | null = null;
  private readonly slider = new LengthSlider((edits, isLast) => this.tryOut(edits, isLast), () => this.askRobot());
  private toml = '';
  /** The dragged joint, as it was at the start of the drag. */
  private dragged: Joint | null = null;
  /** True from the end of a drag until its last position is answered. */
  private isEnding = false;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly session: () => Session,
    private readonly fit: FitView,
  ) {
    this.panel.addEventListener('toggle', () => this.showRobot());
  }

  /** Draws the session's robot in its neutral pose, if the panel is open. */
  showRobot(): void {
    if (!isShown(this.panel)) return;
    const { toml, description } = this.session();
    if (toml === this.toml) return;
    this.toml = toml;
    this.dragged = null;
    this.slider.showRobot(description.lengths);
    this.sketches ??= this.start();
    this.askRobot();
  }

  private start(): NonNullable<typeof this.sketches> {
    const helper = robotHelper(this.module);
    return new LatestQuestion((question) => helper.ask((robot) => robot.lengths(question)), (answer) => this.handleAnswer(answer));
  }

  /** Requests a drawing of the robot as it is, and the range of the slider's length. */
  private askRobot(): void {
    this.sketches?.ask({ toml: this.toml, edits: [], isLast: false, keys: this.slider.keys });
  }

  /** Tries the lengths of a drag; `isLast` is true at its end. */
  private tryOut(edits: Edits, isLast: boolean): void {
    this.isEnding ||= isLast;
    this.sketches?.ask({ toml: this.toml, edits, isLast, keys: [] });
  }

  /** Searches for valid lengths in place of refused ones, and offers them. */
  offer(edits: Edits): void {
    this.sketches?.ask({ toml: this.toml, edits, isLast: true, keys: [] });
  }

  private lengths(): Map<string, Length> {
    return new Map(this.session().description.lengths.map((length) => [length.key, length]));
  }

  private handleAnswer({ edits, text, refusal, scene, nearest, without, isLast, range }: Answer): void {
    if (scene) this.draw(scene, edits.length === 0);
    if (range) this.handleRange(range);
    if (edits.length === 0) return;
    // The answer to `offer`: the user typed a number that was refused.
    if (isLast && !this.isEnding) return showOffers({ nearest, without }, this.session());
    if (!isLast) this.fit.follow(refusal ? null : text);
    const { lengths } = this.session().description;
    const stayText = !isLast ? '' : nearest ? ` It is ${words(nearest.lengths, lengths)}, the nearest that does.` : ' It stays as it was.';
    this.message.textContent = refusal ? `${refusalOf(words(edits, lengths), edits, refusal, lengths)}${stayText}` : `${words(edits, lengths)}.`;
    this.message.classList.toggle('refusal', refusal !== null);
    if (isLast) void this.end(refusal ? (nearest?.text ?? null) : text).then(() => showOffers({ nearest: null, without }, this.session()));
  }

  /** Ends a drag with a new robot.toml; null if the robot stays. */
  private async end(toml: string | null): Promise<void> {
    const session = this.session();
    this.isEnding = false;
    this.dragged = null;
    if (toml !== null && toml !== session.toml) await session.change(toml);
    else this.goBack();
  }

  /** Shows the session's unchanged robot again. */
  private goBack(): void {
    const { lengths } = this.session().description;
    this.slider.showRobot(lengths);
    this.fit.showRobot(lengths);
    this.askRobot();
  }

  private handleRange(range: [number, number]): void {
    this.slider.setRange(range);
    if (this.slider.isChosen) this.fit.findRange(this.slider.keys, range, (printable, message) => this.slider.mark(printable, message));
  }

  /**
   * Draws the robot; if `isWhole`, also fits the view to it. During a drag the view and the joints' elements stay.
   */
  private draw(scene: Scene, isWhole: boolean): void {
    const pictureOf = ([x, y]: Point): Point => [x, -y];
    const lengths = this.lengths();
    this.drawnBars.replaceChildren(
      ...bars(scene).map(({ key, from, to }) => {
        const line = document.createElementNS(SVG, 'line');
        const [[x1, y1], [x2, y2]] = [pictureOf(from), pictureOf(to)];
        for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, String(value));
        line.dataset.key = key;
        const length = lengths.get(key);
        const title = line.appendChild(document.createElementNS(SVG, 'title'));
        title.textContent = length ? `${length.label} (${key.replace('links.', '')}): ${length.value} ${length.unit}` : key;
        line.addEventListener('click', () => this.selectInput(key));
        return line;
      }),
    );
    const points = [...scene.points, ...scene.legs.flatMap(({ foot, joints }) => [foot, ...joints]), ...scene.shafts].map(pictureOf);
    if (isWhole && !this.dragged) {
      const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
      const [left, top] = [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN];
      this.picture.setAttribute('viewBox', `${left} ${top} ${Math.max(...xs) + MARGIN - left} ${Math.max(...ys) + MARGIN - top}`);
    }
    if (this.dragged) {
      // Joints are drawn where their lengths put them, so the dragged joint may be away from the pointer.
      joints(scene, () => 0).forEach(({ at: point }, n) => this.place(this.drawnJoints.children[n], pictureOf(point)));
      return;
    }
    const lengthOf = (key: string) => lengths.get(key)?.value ?? 0;
    this.drawnJoints.replaceChildren(...joints(scene, lengthOf).map((joint) => this.makeJoint(joint, pictureOf(joint.at))));
  }

  private place(mark: Element | undefined, [x, y]: Point): void {
    mark?.setAttribute('cx', String(x));
    mark?.setAttribute('cy', String(y));
  }

  private makeJoint(joint: Joint, position: Point): SVGCircleElement {
    let start: [number, number] | null = null;
    const isDragged = ({ clientX, clientY }: PointerEvent) => {
      if (start && Math.hypot(clientX - start[0], clientY - start[1]) > DRAG_THRESHOLD) start = null;
      return this.dragged === joint && start === null;
    };
    const mark = document.createElementNS(SVG, 'circle');
    mark.setAttribute('r', '3.6');
    mark.dataset.joint = joint.name;
    this.place(mark, position);
    mark.appendChild(document.createElementNS(SVG, 'title')).textContent = joint.name;
    mark.addEventListener('pointerdown', (event) => {
      if (this.isEnding) return;
      mark.setPointerCapture(event.pointerId);
      start = [event.clientX, event.clientY];
      this.dragged = joint;
    });
    mark.addEventListener('pointermove', (event) => isDragged(event) && this.drag(joint, event));
    mark.addEventListener('pointerup', (event) => {
      if (this.dragged !== joint) return;
      if (!isDragged(event)) return void (this.dragged = null);
      this.drag(joint, event, true);
    });
    mark.addEventListener('pointercancel', () => {
      if (this.dragged !== joint) return;
      this.dragged = null;
      this.goBack();
    });
    return mark;
  }

  private drag(joint: Joint, { clientX, clientY }: PointerEvent, isLast = false): void {
    const matrix = this.picture.getScreenCTM();
    if (!matrix) return;
    const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(matrix.inverse());
    this.tryOut(joint.lengthsAt([x, -y], this.symmetric.checked), isLast);
  }

  /** Selects the number input for the length of a clicked bar. */
  private selectInput(key: string): void {
    const input = document.querySelector<HTMLInputElement>(`#lengths input[name="${key}"]`);
    input?.focus();
    input?.select();
  }
}
