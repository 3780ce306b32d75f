// The robot in 3D on the stage, and its panel: the parts, the steps of the building guide, and all files to print and
// to cut. The 3D code is loaded only when 3D is shown or the panel is opened.
import type { RobotView } from '../parts/robot-view';
import type { PartsArchive, CollidingPair, Model, Progress, PartsWorker } from '../parts/make-parts';
import type { Frame, Place } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { saveFile } from './download';
import { element, make, showMessage } from './elements';
import { onPaletteChange } from './palette';
import { isShown } from './rooms';

const ORIGIN: Place = { x: 0, y: 0, heading: 0 };

/** Converts the guide's Markdown, which uses only bold and code, to plain text. */
const toPlainText = (markdown: string) => markdown.replaceAll('**', '').replaceAll('`', '');

const setMessage = (id: string, text: string) => showMessage(element(id), text);

export class PartsView {
  private readonly panel = element<HTMLDetailsElement>('parts');
  private readonly view3d = element('view-3d');
  private readonly button3d = element<HTMLButtonElement>('button-3d');
  private readonly canvas = element<HTMLCanvasElement>('canvas-3d');
  private readonly explosionSlider = element<HTMLInputElement>('explosion');
  private readonly partList = element<HTMLSelectElement>('part');
  /** The buttons that make files: `all` makes every file, `changed` only the files that the edited lengths change. */
  private readonly buttons = { all: element<HTMLButtonElement>('parts-save'), changed: element<HTMLButtonElement>('parts-changed') };
  private robotView: RobotView | null = null;
  /** The worker that computes the poses of the shown robot. */
  private worker: PartsWorker | null = null;
  private model: Model | null = null;
  /** The robot.toml that is shown or being loaded; empty for none. */
  private requestedToml = '';
  /** The robot.toml of the shown list of files. */
  private listedToml = '';
  /** The number of the shown step of the guide, from 1; null for the whole robot. */
  private step: number | null = null;
  /** The index of the picked body; null for none. */
  private pickedBody: number | null = null;
  /** The two parts that overlap or come too close, which are shown in red; null if all parts fit. */
  private collidingPair: CollidingPair | null = null;
  /** Angles and lags of the last requested pose, as text; empty if the pose must be requested again. */
  private requestedPose = '';
  /** Cancels making files; null while no files are being made. */
  private cancelMaking: (() => void) | null = null;

  constructor(private readonly session: Session) {
    this.button3d.addEventListener('click', () => this.set3d(!this.is3d));
    // The guide describes the robot on the stage.
    this.panel.addEventListener('toggle', () => isShown(this.panel) && this.set3d(true));
    this.explosionSlider.addEventListener('input', () => this.updateRobotView());
    this.partList.addEventListener('change', () => this.pickBody(this.partList.value === '' ? null : Number(this.partList.value)));
    element('step-back').addEventListener('click', () => this.stepBy(-1));
    element('step-on').addEventListener('click', () => this.stepBy(1));
    element('step-all').addEventListener('click', () => this.showStep(null));
    for (const [id, key] of [['zoom-in', '+'], ['zoom-out', '-'], ['home', 'Home']] as const) {
      element(id).addEventListener('click', () => this.robotView?.handleKey(key));
    }
    this.buttons.all.addEventListener('click', () => void this.makeFiles('all'));
    this.buttons.changed.addEventListener('click', () => void this.makeFiles('changed'));
    onPaletteChange(() => this.updateRobotView());
  }

  /** True while the stage shows the robot in 3D. */
  get is3d(): boolean {
    return !this.view3d.hidden;
  }

  set3d(is3d: boolean): void {
    this.view3d.hidden = !is3d;
    this.button3d.setAttribute('aria-pressed', String(is3d));
    this.showRobot();
  }

  /** Shows the session's robot, if the stage is in 3D. */
  showRobot(): void {
    const { toml, original } = this.session.robot;
    this.buttons.changed.hidden = toml === original;
    if (this.listedToml !== toml) {
      this.listedToml = toml;
      this.listFiles([]);
      if (!this.cancelMaking) setMessage('files-message', '');
    }
    this.show3d(toml);
  }

  /**
   * Shows a robot, which may differ from the session's, if the stage is in 3D. A robot other than the shown one cancels
   * the making of files.
   */
  show3d(toml: string): void {
    if (!this.is3d || toml === this.requestedToml) return;
    this.requestedToml = toml;
    this.cancelMaking?.();
    void this.load(toml);
  }

  private async load(toml: string): Promise<void> {
    setMessage('parts-message', 'Building the 3D model…');
    try {
      const [{ makeModel }, { RobotView }] = await Promise.all([import('../parts/make-parts'), import('../parts/robot-view')]);
      const { worker, model, solids } = await makeModel(toml);
      if (toml !== this.requestedToml) return worker.terminate();
      // The previous robot stays on the stage until this point.
      this.worker?.terminate();
      this.worker = worker;
      this.model = model;
      this.requestedPose = '';
      this.fillPartList(model);
      this.robotView ??= this.createRobotView(RobotView);
      this.robotView?.showModel(model, solids);
      this.showStep(this.step !== null && this.step <= model.steps.length ? this.step : null);
      this.pickBody(null);
    } catch (error) {
      if (toml !== this.requestedToml) return;
      // A failed attempt is repeated when the 3D view is opened again.
      this.requestedToml = '';
      setMessage('parts-message', `Cannot make the parts of this robot: ${getMessage(error)}${this.model ? ' The previous robot is still shown.' : ''}`);
    }
  }

  /** Creates the 3D view; returns null and shows a message if the browser has no WebGL. */
  private createRobotView(RobotViewClass: typeof RobotView): RobotView | null {
    try {
      return new RobotViewClass(this.canvas, (body) => this.pickBody(body));
    } catch {
      this.canvas.hidden = true;
      setMessage('canvas-3d-none', 'This browser has no WebGL, or WebGL is switched off, so the page cannot show the robot in 3D. You can still make the files.');
      return null;
    }
  }

  private fillPartList(model: Model): void {
    const bodies = model.bodies.map(({ name }, index) => ({ name, index }));
    bodies.sort((a, b) => a.name.localeCompare(b.name));
    this.partList.replaceChildren(new Option('none', ''), ...bodies.map(({ name, index }) => new Option(name, String(index))));
  }

  private stepBy(change: number): void {
    if (!this.model) return;
    const lastStep = this.model.steps.length;
    this.showStep(this.step === null ? (change > 0 ? 1 : lastStep) : Math.max(1, Math.min(lastStep, this.step + change)));
  }

  /** Shows a step with its new parts exploded, as in the guide's picture; null shows the assembled robot. */
  private showStep(step: number | null): void {
    if (!this.model) return;
    if ((step === null) !== (this.step === null)) this.explosionSlider.value = step === null ? '0' : '100';
    this.step = step;
    this.requestedPose = '';
    const shownStep = step === null ? undefined : this.model.steps[step - 1];
    const stepCount = this.model.steps.length;
    setMessage('step-title', shownStep ? `${step} of ${stepCount}: ${shownStep.title}` : 'The whole robot');
    setMessage('step-words', shownStep ? toPlainText(shownStep.instructions) : '');
    element<HTMLButtonElement>('step-back').disabled = step === 1;
    element<HTMLButtonElement>('step-on').disabled = step === stepCount;
    element<HTMLButtonElement>('step-all').disabled = step === null;
    this.updateRobotView();
  }

  /** Highlights and describes the body with this index; null for none. */
  private pickBody(index: number | null): void {
    this.pickedBody = index;
    this.partList.value = index === null ? '' : String(index);
    const body = index === null ? undefined : this.model?.bodies[index];
    const part = body?.part == null ? undefined : this.model?.parts[body.part];
    const { collidingPair } = this;
    if (collidingPair) {
      const { first, second, mm } = collidingPair;
      setMessage('parts-message', `${first} and ${second} ${mm < 0 ? `overlap by ${(-mm).toFixed(2)} mm` : `are only ${mm.toFixed(2)} mm apart`}.`);
    } else if (!body) setMessage('parts-message', this.robotView ? 'Click a part for its name and its file.' : '');
    else if (!part) setMessage('parts-message', `${body.name}: ${body.kind}, bought; mounted in step ${body.step}.`);
    else {
      const countText = part.count === 1 ? 'printed once' : `printed ${part.count} times`;
      setMessage('parts-message', `${body.name}: ${countText}, stl/${part.file}.stl and step/${part.file}.step; mounted in step ${body.step}.`);
    }
    this.updateRobotView();
  }

  /** Shows two colliding parts in red, in the pose of their collision; null if all parts fit. */
  showCollidingPair(pair: CollidingPair | null): void {
    if (pair === this.collidingPair) return;
    this.collidingPair = pair;
    this.requestedPose = '';
    this.pickBody(this.pickedBody);
  }

  private updateRobotView(): void {
    element('explosion-out').textContent = `${this.explosionSlider.value} %`;
    const { step, pickedBody, collidingPair, model } = this;
    const names = collidingPair ? [collidingPair.first, collidingPair.second] : [];
    const collidingBodies = names.map((name) => model?.bodies.findIndex((body) => body.name === name) ?? -1);
    this.robotView?.applySettings({ explosion: Number(this.explosionSlider.value) / 100, guideStep: step, selectedBody: pickedBody, collidingBodies });
  }

  /** Renders the robot; called in every animation frame. */
  render(frame: Frame | null): void {
    const { robotView, worker } = this;
    if (!robotView || !worker || !robotView.renderBudget.mayRender() || !this.is3d) return;
    const neutralAngles = this.session.robot.description.servos.map((servo) => servo.neutral);
    // The robot stands still while a step of the guide or a collision is shown.
    const isMoving = this.step === null && !this.collidingPair && frame?.scene != null;
    const [angles, lags] = isMoving ? [frame.scene?.angles ?? neutralAngles, frame.lags] : [this.collidingPair?.pose ?? neutralAngles, [0, 0, 0, 0]];
    const poseText = [...angles, ...lags].map((angle) => angle.toFixed(2)).join(' ');
    if (poseText !== this.requestedPose) {
      this.requestedPose = poseText;
      void worker.computeMountPlaces(angles, lags).then((places) => {
        if (worker !== this.worker) return;
        if (places) robotView.placeMounts(places);
        // Another pose was being computed; this pose is requested again.
        else if (this.requestedPose === poseText) this.requestedPose = '';
      });
    }
    robotView.render(isMoving ? frame.place : ORIGIN);
  }

  private async makeFiles(selection: 'all' | 'changed'): Promise<void> {
    // While files are being made, the button cancels the job.
    if (this.cancelMaking) return this.cancelMaking();
    const { toml, original, file } = this.session.robot;
    const progressBar = element<HTMLProgressElement>('parts-progress');
    const stageTexts = { prove: 'Proving that no two parts collide', make: 'Making the files' };
    const button = this.buttons[selection];
    const label = button.textContent;
    progressBar.hidden = false;
    progressBar.removeAttribute('value');
    button.textContent = 'Stop';
    this.cancelMaking = () => {};
    setMessage('files-message', 'Loading…');
    this.listFiles([]);
    const cancellation = new AbortController();
    let isOver = false;
    try {
      const { makeArchive } = await import('../parts/make-parts');
      this.cancelMaking = () => cancellation.abort();
      const showProgress = ({ stage, done, total }: Progress) => {
        // Reports have their own channel: some arrive after the result, or after the worker was terminated.
        if (isOver) return;
        progressBar.max = total;
        progressBar.value = done;
        setMessage('files-message', `${stageTexts[stage]}: ${done} of ${total}.`);
      };
      const archive = await makeArchive(toml, selection === 'all' ? null : original, showProgress, cancellation.signal).finally(() => (isOver = true));
      if (!archive) return;
      if (archive.paths.length > 0) saveFile(`${file || 'robot'}-${selection === 'all' ? 'parts' : 'changed-parts'}.zip`, [archive.zip], 'application/zip');
      setMessage('files-message', this.describeArchive(archive, selection, file));
      if (selection === 'changed') this.listFiles(archive.paths);
    } catch (error) {
      setMessage('files-message', `Cannot make the files: ${getMessage(error)}`);
    } finally {
      this.cancelMaking = null;
      progressBar.hidden = true;
      button.textContent = label;
      if (cancellation.signal.aborted) setMessage('files-message', 'Stopped; nothing was saved.');
    }
  }

  private describeArchive({ paths, fileCount, minDistanceMm }: PartsArchive, selection: 'all' | 'changed', file: string): string {
    const distanceText = minDistanceMm === null ? '' : ` No two parts come closer to each other than ${minDistanceMm.toFixed(2)} mm in any pose that the guard accepts.`;
    if (selection === 'all') return `${fileCount} files.${distanceText}`;
    return paths.length === 0 ? `None of the ${fileCount} files changed.` : `${paths.length} of ${fileCount} files differ from the files of ${file}.toml:`;
  }

  private listFiles(paths: string[]): void {
    const list = element('files-list');
    list.replaceChildren(...paths.map((path) => make('li', {}, path)));
    list.hidden = paths.length === 0;
  }
}
