// A drawing of the robot with joints that the user can drag, and a slider for one length. Invalid lengths are refused
// during the drag.
import type { Edits, Length, Scene, Point } from '../robot';
import { createRobotQueue } from '../robot-requests';
import type { RobotWorkerApi } from '../robot-worker';
import type { Session } from '../session';
import { type Joint, listBars, listJoints } from '../sketch/joints';
import type { FitView } from './fit';
import { LengthSlider } from './length-slider';
import { element, makeSvg, setAttributes, toPicture } from './elements';
import { followShownRobot } from './rooms';
import { describeRefusal, showOffers, formatLengths } from './tried-lengths';

type LengthsRequest = Parameters<RobotWorkerApi['tryLengths']>[0];
type LengthsResponse = ReturnType<RobotWorkerApi['tryLengths']>;

/** Pointer movement, in CSS pixels, beyond which a press counts as a drag. */
const DRAG_THRESHOLD_PX = 3;
/** Margin around the robot in the drawing. */
const MARGIN_MM = 14;

export class SketchView {
  private readonly picture = element<HTMLElement>('sketch') as unknown as SVGSVGElement;
  private readonly message = element('sketch-message');
  private readonly barGroup = this.picture.appendChild(makeSvg('g', {}));
  private readonly jointGroup = this.picture.appendChild(makeSvg('g', {}));
  /** Tries other lengths in a worker. */
  private readonly lengthsQueue = createRobotQueue((robot, request: LengthsRequest) => robot.tryLengths(request), (response: LengthsResponse) => this.handleResponse(response));
  private readonly slider = new LengthSlider((edits, isDragEnd) => this.tryLengths(edits, isDragEnd), () => this.requestDrawing());
  /** The dragged joint, in its state at the start of the drag; null if none is dragged. */
  private draggedJoint: Joint | null = null;
  /** True between the end of a drag and the response for its last position. */
  private isDragEnding = false;

  constructor(
    private readonly session: Session,
    private readonly fit: FitView,
  ) {
    followShownRobot(element<HTMLDetailsElement>('lengths-panel'), session, ({ lengths }) => this.showRobot(lengths));
  }

  /** Shows the session's robot in its neutral pose, and ends any drag. */
  private showRobot(lengths: Length[]): void {
    this.draggedJoint = null;
    this.isDragEnding = false;
    this.slider.showRobot(lengths);
    this.requestDrawing();
  }

  /** Requests a drawing of the session's robot and the range of the slider's length. */
  private requestDrawing(): void {
    // The request would replace the queued last position of a drag; the end of the drag requests a drawing, too.
    if (this.isDragEnding) return;
    this.lengthsQueue.submit({ toml: this.session.robot.toml, edits: [], isLast: false, keys: this.slider.keys });
  }

  /** Tries the lengths of a drag; `isDragEnd` is true at its end. */
  private tryLengths(edits: Edits, isDragEnd: boolean): void {
    this.isDragEnding ||= isDragEnd;
    this.lengthsQueue.submit({ toml: this.session.robot.toml, edits, isLast: isDragEnd, keys: [] });
  }

  /** Searches for valid alternatives to refused lengths and offers them. */
  offerValidLengths(edits: Edits): void {
    this.lengthsQueue.submit({ toml: this.session.robot.toml, edits, isLast: true, keys: [] });
  }

  private handleResponse({ toml, edits, text, refusal, scene, nearest, without, isLast, range }: LengthsResponse): void {
    // The robot has changed since the request.
    if (toml !== this.session.robot.toml) return;
    if (scene) this.draw(scene, edits.length === 0);
    if (range) this.applyRange(range);
    if (edits.length === 0) return;
    // This response belongs to `offerValidLengths`: the user has typed a number that was refused.
    if (isLast && !this.isDragEnding) return showOffers({ nearest, without }, this.session);
    if (!isLast) this.fit.checkDragged(refusal ? null : text);
    const { lengths } = this.session.robot.description;
    const outcomeText = !isLast ? '' : nearest ? ` The nearest valid value is used: ${formatLengths(nearest.lengths, lengths)}.` : ' The length stays unchanged.';
    this.message.textContent = refusal ? `${describeRefusal(formatLengths(edits, lengths), edits, refusal, lengths)}${outcomeText}` : `${formatLengths(edits, lengths)}.`;
    this.message.classList.toggle('refusal', refusal !== null);
    if (isLast) void this.endDrag(refusal ? (nearest?.text ?? null) : text).then(() => showOffers({ nearest: null, without }, this.session));
  }

  /** Ends a drag and loads the resulting robot.toml; null keeps the robot. */
  private async endDrag(toml: string | null): Promise<void> {
    this.isDragEnding = false;
    this.draggedJoint = null;
    if (toml !== null && toml !== this.session.robot.toml) await this.session.robot.change(toml);
    else this.showUnchanged();
  }

  private showUnchanged(): void {
    const { lengths } = this.session.robot.description;
    this.showRobot(lengths);
    this.fit.showRobot(lengths);
  }

  private applyRange(range: [number, number]): void {
    this.slider.setRange(range);
    if (this.slider.hasUserChosen) this.fit.findRange(this.slider.keys, range, (printable, message) => this.slider.showPrintableRange(printable, message));
  }

  /** Draws the robot; if `fitsView`, fits the view to it. A drag keeps the view and the elements of the joints. */
  private draw(scene: Scene, fitsView: boolean): void {
    const flip = ([x, y]: Point): Point => [x, -y];
    const lengths = new Map(this.session.robot.description.lengths.map((length) => [length.key, length]));
    this.barGroup.replaceChildren(
      ...listBars(scene).map(({ key, from, to }) => {
        const [[x1, y1], [x2, y2]] = [flip(from), flip(to)];
        const length = lengths.get(key);
        const title = length ? `${length.label} (${key.replace('links.', '')}): ${length.value} ${length.unit}` : key;
        const line = makeSvg('line', { x1, y1, x2, y2, 'data-key': key }, makeSvg('title', {}, title));
        line.addEventListener('click', () => this.selectInput(key));
        return line;
      }),
    );
    const points = [...scene.points, ...scene.legs.flatMap(({ foot, joints }) => [foot, ...joints]), ...scene.shafts].map(flip);
    if (fitsView && !this.draggedJoint) {
      const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
      const [left, top] = [Math.min(...xs) - MARGIN_MM, Math.min(...ys) - MARGIN_MM];
      this.picture.setAttribute('viewBox', `${left} ${top} ${Math.max(...xs) + MARGIN_MM - left} ${Math.max(...ys) + MARGIN_MM - top}`);
    }
    if (this.draggedJoint) {
      // The lengths determine the joints' positions; the dragged joint may therefore not be under the pointer.
      listJoints(scene, () => 0).forEach(({ position: [x, y] }, n) => setAttributes(this.jointGroup.children[n], { cx: x, cy: -y }));
      return;
    }
    const getLength = (key: string) => lengths.get(key)?.value ?? 0;
    this.jointGroup.replaceChildren(...listJoints(scene, getLength).map((joint) => this.makeJoint(joint, flip(joint.position))));
  }

  private makeJoint(joint: Joint, [cx, cy]: Point): SVGCircleElement {
    let pressPoint: [number, number] | null = null;
    /** Returns true once the pressed pointer has moved far enough for a drag. */
    const updateDrag = ({ clientX, clientY }: PointerEvent) => {
      if (pressPoint && Math.hypot(clientX - pressPoint[0], clientY - pressPoint[1]) > DRAG_THRESHOLD_PX) pressPoint = null;
      return this.draggedJoint === joint && pressPoint === null;
    };
    const circle = makeSvg('circle', { cx, cy, r: 3.6, 'data-joint': joint.name }, makeSvg('title', {}, joint.name));
    circle.addEventListener('pointerdown', (event) => {
      if (this.isDragEnding) return;
      circle.setPointerCapture(event.pointerId);
      pressPoint = [event.clientX, event.clientY];
      this.draggedJoint = joint;
    });
    circle.addEventListener('pointermove', (event) => updateDrag(event) && this.dragJoint(joint, event));
    circle.addEventListener('pointerup', (event) => {
      if (this.draggedJoint !== joint) return;
      if (!updateDrag(event)) return void (this.draggedJoint = null);
      this.dragJoint(joint, event, true);
    });
    circle.addEventListener('pointercancel', () => this.draggedJoint === joint && this.showUnchanged());
    return circle;
  }

  private dragJoint(joint: Joint, event: PointerEvent, isDragEnd = false): void {
    const position = toPicture(this.picture, event);
    if (position) this.tryLengths(joint.makeEdits([position.x, -position.y], element<HTMLInputElement>('alike').checked), isDragEnd);
  }

  /** Selects the number input for the length of a clicked bar. */
  private selectInput(key: string): void {
    const input = document.querySelector<HTMLInputElement>(`#lengths input[name="${key}"]`);
    input?.focus();
    input?.select();
  }
}
