// The robot in 3D on the stage, and its panel: the parts, the guide step by step, and all files to print and to cut.
// Its code is loaded only when 3D is shown or the panel is opened.
import type { Space } from '../parts/space';
import type { Made, Meeting, Model, Progress, Solids } from '../parts/workshop';
import type { Frame, Place } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';
import { save } from './download';
import { make } from './make';
import { onPaletteChange } from './palette';
import { isShown } from './rooms';

const ORIGIN: Place = { x: 0, y: 0, heading: 0 };

/** Converts the guide's Markdown, which uses only bold and code, to plain text. */
const plainText = (words: string) => words.replaceAll('**', '').replaceAll('`', '');

export class PartsView {
  private readonly panel = element<HTMLDetailsElement>('parts');
  private readonly view = element('solids');
  private readonly button3d = element<HTMLButtonElement>('solid');
  private readonly canvas = element<HTMLCanvasElement>('space');
  private readonly apart = element<HTMLInputElement>('apart');
  private readonly list = element<HTMLSelectElement>('part');
  /** The buttons that make files: all files, or only files that changed lengths change. */
  private readonly buttons = { all: element<HTMLButtonElement>('parts-save'), changed: element<HTMLButtonElement>('parts-changed') };
  private space: Space | null = null;
  private solids: Solids | null = null;
  private model: Model | null = null;
  /** The robot.toml that is shown or being loaded. */
  private toml = '';
  /** The robot.toml to which the shown list of files belongs. */
  private made = '';
  private step: number | null = null;
  private picked: number | null = null;
  /** The two parts that come too close, shown in red; null if all fit. */
  private meeting: Meeting | null = null;
  /** Angles and lags of the pose that was requested last, as a text; empty if it must be requested again. */
  private requestedPose = '';
  private stop: (() => void) | null = null;

  constructor(private readonly session: () => Session) {
    this.button3d.addEventListener('click', () => this.set3d(!this.is3d));
    // The guide describes the robot on the stage.
    this.panel.addEventListener('toggle', () => isShown(this.panel) && this.set3d(true));
    this.apart.addEventListener('input', () => this.show());
    this.list.addEventListener('change', () => this.pick(this.list.value === '' ? null : Number(this.list.value)));
    element('step-back').addEventListener('click', () => this.stepBy(-1));
    element('step-on').addEventListener('click', () => this.stepBy(1));
    element('step-all').addEventListener('click', () => this.toStep(null));
    for (const [id, key] of [['zoom-in', '+'], ['zoom-out', '-'], ['home', 'Home']] as const) {
      element(id).addEventListener('click', () => this.space?.press(key));
    }
    this.buttons.all.addEventListener('click', () => void this.makeFiles('all'));
    this.buttons.changed.addEventListener('click', () => void this.makeFiles('changed'));
    onPaletteChange(() => this.show());
  }

  /** True while the stage shows the robot in 3D. */
  get is3d(): boolean {
    return !this.view.hidden;
  }

  set3d(is3d: boolean): void {
    this.view.hidden = !is3d;
    this.button3d.setAttribute('aria-pressed', String(is3d));
    this.showRobot();
  }

  /** Shows the session's robot, if the stage is in 3D. */
  showRobot(): void {
    const { toml, original } = this.session();
    this.buttons.changed.hidden = toml === original;
    if (this.made !== toml) {
      this.made = toml;
      this.listFiles([]);
      if (!this.stop) this.say('files-said', '');
    }
    this.show3d(toml);
  }

  /** Shows a robot, also one that is not the session's yet, if the stage is in 3D. */
  show3d(toml: string): void {
    if (!this.is3d || toml === this.toml) return;
    this.toml = toml;
    this.stop?.();
    void this.load(toml);
  }

  private async load(toml: string): Promise<void> {
    this.say('parts-said', 'Making the solids…');
    try {
      const [{ Solids }, { Space }] = await Promise.all([import('../parts/workshop'), import('../parts/space')]);
      const { solids, model, meshes } = await Solids.of(toml);
      if (toml !== this.toml) return solids.end();
      // The previous robot is shown until then.
      this.solids?.end();
      this.solids = solids;
      this.model = model;
      this.requestedPose = '';
      this.fill(model);
      this.space ??= this.open(Space);
      this.space?.showModel(model, meshes);
      this.toStep(this.step !== null && this.step <= model.steps.length ? this.step : null);
      this.pick(null);
    } catch (error) {
      if (toml !== this.toml) return;
      // A failed download is tried again when 3D is shown again.
      this.toml = '';
      this.say('parts-said', `There are no parts of this robot: ${messageOf(error)}${this.model ? ' The one before is shown.' : ''}`);
    }
  }

  private open(space: typeof Space): Space | null {
    try {
      return new space(this.canvas, (body) => this.pick(body));
    } catch {
      this.canvas.hidden = true;
      this.say('space-none', 'This browser has no WebGL, or it is switched off, so the robot cannot be shown in space. The files can be made all the same.');
      return null;
    }
  }

  private fill(model: Model): void {
    const bodies = model.bodies.map(({ name }, number) => ({ name, number }));
    bodies.sort((a, b) => a.name.localeCompare(b.name));
    this.list.replaceChildren(new Option('none', ''), ...bodies.map(({ name, number }) => new Option(name, String(number))));
  }

  private stepBy(change: number): void {
    if (!this.model) return;
    const lastStep = this.model.steps.length;
    this.toStep(this.step === null ? (change > 0 ? 1 : lastStep) : Math.max(1, Math.min(lastStep, this.step + change)));
  }

  /** Shows a step's new parts exploded, as the guide's picture does; for null, all parts assembled. */
  private toStep(step: number | null): void {
    if (!this.model) return;
    if ((step === null) !== (this.step === null)) this.apart.value = step === null ? '0' : '100';
    this.step = step;
    this.requestedPose = '';
    const shownStep = step === null ? undefined : this.model.steps[step - 1];
    const count = this.model.steps.length;
    this.say('step-title', shownStep ? `${step} of ${count}: ${shownStep.title}` : 'The whole robot');
    this.say('step-words', shownStep ? plainText(shownStep.words) : '');
    element<HTMLButtonElement>('step-back').disabled = step === 1;
    element<HTMLButtonElement>('step-on').disabled = step === count;
    element<HTMLButtonElement>('step-all').disabled = step === null;
    this.show();
  }

  private pick(number: number | null): void {
    this.picked = number;
    this.list.value = number === null ? '' : String(number);
    const body = number === null ? undefined : this.model?.bodies[number];
    const part = body?.part == null ? undefined : this.model?.parts[body.part];
    const { meeting } = this;
    if (meeting) {
      const { first, second, mm } = meeting;
      this.say('parts-said', `${first} and ${second}: ${mm < 0 ? `${(-mm).toFixed(2)} mm too much` : `only ${mm.toFixed(2)} mm apart`}.`);
    } else if (!body) this.say('parts-said', this.space ? 'Click a part for its name and its file.' : '');
    else if (!part) this.say('parts-said', `${body.name}: ${body.kind}, bought; put on in step ${body.step}.`);
    else {
      const countText = part.count === 1 ? 'printed once' : `printed ${part.count} times`;
      this.say('parts-said', `${body.name}: ${countText}, stl/${part.file}.stl and step/${part.file}.step; put on in step ${body.step}.`);
    }
    this.show();
  }

  /** Shows two parts that come too close in red, at the pose where they do; null if all fit. */
  meet(meeting: Meeting | null): void {
    if (meeting === this.meeting) return;
    this.meeting = meeting;
    this.requestedPose = '';
    this.pick(this.picked);
  }

  private show(): void {
    element('apart-out').textContent = `${this.apart.value} %`;
    const { step, picked, meeting, model } = this;
    const names = meeting ? [meeting.first, meeting.second] : [];
    const clash = names.map((name) => model?.bodies.findIndex((body) => body.name === name) ?? -1);
    this.space?.show({ apart: Number(this.apart.value) / 100, step, picked, clash });
  }

  /** Called in every frame of the page. */
  draw(frame: Frame | null): void {
    const { space, solids } = this;
    if (!space || !solids || !space.mayDraw() || !this.is3d) return;
    const neutral = this.session().description.servos.map((servo) => servo.neutral);
    // The robot stands still while a step of the guide, or a pose in which two parts come too close, is shown.
    const isMoving = this.step === null && !this.meeting && frame?.scene != null;
    const [angles, lags] = isMoving ? [frame.scene?.angles ?? neutral, frame.lag] : [this.meeting?.pose ?? neutral, [0, 0, 0, 0]];
    const poseText = [...angles, ...lags].map((angle) => angle.toFixed(2)).join(' ');
    if (poseText !== this.requestedPose) {
      this.requestedPose = poseText;
      void solids.pose(angles, lags).then((places) => {
        if (solids !== this.solids) return;
        if (places) space.pose(places);
        // Another pose was being computed, so this one is requested again.
        else if (this.requestedPose === poseText) this.requestedPose = '';
      });
    }
    space.draw(isMoving ? frame.place : ORIGIN);
  }

  private async makeFiles(selection: 'all' | 'changed'): Promise<void> {
    // The button also stops the making.
    if (this.stop) return this.stop();
    const { toml, original, file } = this.session();
    const bar = element<HTMLProgressElement>('parts-progress');
    const activityTexts = { prove: 'Proving that no two parts meet', make: 'Making the files' };
    const button = this.buttons[selection];
    const label = button.textContent;
    bar.hidden = false;
    bar.removeAttribute('value');
    button.textContent = 'Stop';
    this.stop = () => {};
    this.say('files-said', 'Loading…');
    this.listFiles([]);
    let isStopped = false;
    let isOver = false;
    try {
      const workshop = await import('../parts/workshop');
      const { answer, stop } = workshop.make(toml, selection === 'all' ? null : original, ({ doing, done, all }: Progress) => {
        // Reports have a channel of their own: some arrive after the answer, or after the worker was terminated.
        if (isOver) return;
        bar.max = all;
        bar.value = done;
        this.say('files-said', `${activityTexts[doing]}: ${done} of ${all}.`);
      });
      const stopPromise = new Promise<null>((resolve) => {
        this.stop = () => {
          isStopped = true;
          stop();
          resolve(null);
        };
      });
      const files = await Promise.race([answer, stopPromise]).finally(() => (isOver = true));
      if (!files) return;
      if (files.paths.length > 0) save(`${file || 'robot'}-${selection === 'all' ? 'parts' : 'changed-parts'}.zip`, [files.zip], 'application/zip');
      this.say('files-said', this.savedText(files, selection));
      if (selection === 'changed') this.listFiles(files.paths);
    } catch (error) {
      this.say('files-said', `No files are made: ${messageOf(error)}`);
    } finally {
      this.stop = null;
      bar.hidden = true;
      button.textContent = label;
      if (isStopped) this.say('files-said', 'Stopped; nothing was saved.');
    }
  }

  private savedText({ paths, count, least: leastMm }: Made, selection: 'all' | 'changed'): string {
    const distanceText = leastMm === null ? '' : ` No two parts come nearer than ${leastMm.toFixed(2)} mm at any pose that the guard accepts.`;
    if (selection === 'all') return `${count} files.${distanceText}`;
    return paths.length === 0 ? `None of the ${count} files changed.` : `${paths.length} of ${count} files are not those of ${this.session().file}.toml:`;
  }

  private listFiles(paths: string[]): void {
    const box = element('files-list');
    box.replaceChildren(...paths.map((path) => make('li', {}, path)));
    box.hidden = paths.length === 0;
  }

  private say(id: string, text: string): void {
    const box = element(id);
    box.textContent = text;
    box.hidden = text === '';
  }
}
