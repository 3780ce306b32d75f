// The robot in 3D on the stage, and its panel: the parts, the guide step by step, and all files to print and to cut.
// Nothing of it is loaded before 3D is shown or the panel is opened.
import type { Model } from '../parts/model';
import type { Space } from '../parts/space';
import type { Progress, Solids } from '../parts/workshop';
import type { Frame, Place } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';
import { save } from './download';
import { onPaletteChange } from './palette';
import { isShown } from './rooms';

const ORIGIN: Place = { x: 0, y: 0, heading: 0 };

/** Converts the guide's Markdown, which uses only bold and code, to plain text. */
const plain = (words: string) => words.replaceAll('**', '').replaceAll('`', '');

export class PartsView {
  private readonly panel = element<HTMLDetailsElement>('parts');
  private readonly view = element('solids');
  private readonly button3d = element<HTMLButtonElement>('solid');
  private readonly canvas = element<HTMLCanvasElement>('space');
  private readonly apart = element<HTMLInputElement>('apart');
  private readonly list = element<HTMLSelectElement>('part');
  private readonly button = element<HTMLButtonElement>('parts-save');
  private space: Space | null = null;
  private solids: Solids | null = null;
  private model: Model | null = null;
  /** The robot.toml that is shown or being loaded. */
  private toml = '';
  private step: number | null = null;
  private picked: number | null = null;
  /** The request of the last pose. */
  private asked = '';
  private stop: (() => void) | null = null;

  constructor(private readonly session: () => Session) {
    this.button3d.addEventListener('click', () => this.set3d(!this.is3d));
    // The guide is about what the stage shows.
    this.panel.addEventListener('toggle', () => isShown(this.panel) && this.set3d(true));
    this.apart.addEventListener('input', () => this.show());
    this.list.addEventListener('change', () => this.pick(this.list.value === '' ? null : Number(this.list.value)));
    element('step-back').addEventListener('click', () => this.stepBy(-1));
    element('step-on').addEventListener('click', () => this.stepBy(1));
    element('step-all').addEventListener('click', () => this.toStep(null));
    for (const [id, key] of [['zoom-in', '+'], ['zoom-out', '-'], ['home', 'Home']] as const) {
      element(id).addEventListener('click', () => this.space?.press(key));
    }
    this.button.addEventListener('click', () => void this.files());
    onPaletteChange(() => this.show());
  }

  /** True while the stage shows the robot in 3D. */
  get is3d(): boolean {
    return !this.view.hidden;
  }

  private set3d(is3d: boolean): void {
    this.view.hidden = !is3d;
    this.button3d.setAttribute('aria-pressed', String(is3d));
    this.showRobot();
  }

  /** Takes the session's robot, if it is shown in 3D. */
  showRobot(): void {
    const { toml } = this.session();
    if (!this.is3d || toml === this.toml) return;
    this.toml = toml;
    this.stop?.();
    void this.load(toml);
  }

  private async load(toml: string): Promise<void> {
    this.say('parts-said', 'Making the solids…');
    this.solids?.end();
    this.solids = null;
    this.model = null;
    try {
      const [{ Solids }, { Space }] = await Promise.all([import('../parts/workshop'), import('../parts/space')]);
      const { solids, model, meshes } = await Solids.of(toml);
      if (toml !== this.toml) return solids.end();
      this.solids = solids;
      this.model = model;
      this.asked = '';
      this.fill(model);
      this.space ??= this.open(Space);
      this.space?.showModel(model, meshes);
      this.toStep(this.step !== null && this.step <= model.steps.length ? this.step : null);
      this.pick(null);
    } catch (error) {
      if (toml !== this.toml) return;
      // A failed download is tried again when 3D is shown again.
      this.toml = '';
      this.say('parts-said', `There are no parts of this robot: ${messageOf(error)}`);
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

  private stepBy(by: number): void {
    if (!this.model) return;
    const last = this.model.steps.length;
    this.toStep(this.step === null ? (by > 0 ? 1 : last) : Math.max(1, Math.min(last, this.step + by)));
  }

  /** Shows a step's new parts apart, as the guide's picture does; without a step, all parts together. */
  private toStep(step: number | null): void {
    if (!this.model) return;
    if ((step === null) !== (this.step === null)) this.apart.value = step === null ? '0' : '100';
    this.step = step;
    this.asked = '';
    const found = step === null ? undefined : this.model.steps[step - 1];
    const count = this.model.steps.length;
    this.say('step-title', found ? `${step} of ${count}: ${found.title}` : 'The whole robot');
    this.say('step-words', found ? plain(found.words) : '');
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
    if (!body) this.say('parts-said', this.space ? 'Click a part for its name and its file.' : '');
    else if (!part) this.say('parts-said', `${body.name}: ${body.kind}, bought; put on in step ${body.step}.`);
    else {
      const often = part.count === 1 ? 'printed once' : `printed ${part.count} times`;
      this.say('parts-said', `${body.name}: ${often}, stl/${part.file}.stl and step/${part.file}.step; put on in step ${body.step}.`);
    }
    this.show();
  }

  private show(): void {
    element('apart-out').textContent = `${this.apart.value} %`;
    this.space?.show({ apart: Number(this.apart.value) / 100, step: this.step, picked: this.picked });
  }

  /** Called in every frame of the page. */
  draw(frame: Frame | null): void {
    const { space, solids } = this;
    if (!space || !solids || !space.mayDraw() || !this.is3d) return;
    const neutral = this.session().description.servos.map((servo) => servo.neutral);
    // The robot stands still while a step of the guide is shown.
    const moving = this.step === null && frame?.scene != null;
    const [angles, lags] = moving ? [frame.scene?.angles ?? neutral, frame.lag] : [neutral, [0, 0, 0, 0]];
    const asked = [...angles, ...lags].map((angle) => angle.toFixed(2)).join(' ');
    if (asked !== this.asked) {
      this.asked = asked;
      void solids.pose(angles, lags).then((places) => {
        if (solids !== this.solids) return;
        if (places) space.pose(places);
        // Another pose was in progress, so this one is requested again.
        else if (this.asked === asked) this.asked = '';
      });
    }
    space.draw(moving ? frame.place : ORIGIN);
  }

  private async files(): Promise<void> {
    // The button also stops the making.
    if (this.stop) return this.stop();
    const { toml, file } = this.session();
    const bar = element<HTMLProgressElement>('parts-progress');
    const words = { prove: 'Proving that no two parts meet', make: 'Making the files' };
    bar.hidden = false;
    bar.removeAttribute('value');
    this.button.textContent = 'Stop';
    this.stop = () => {};
    this.say('files-said', 'Loading…');
    let stopped = false;
    try {
      const { make } = await import('../parts/workshop');
      const { made, stop } = make(toml, ({ doing, done, all }: Progress) => {
        bar.max = all;
        bar.value = done;
        this.say('files-said', `${words[doing]}: ${done} of ${all}.`);
      });
      const halted = new Promise<null>((end) => {
        this.stop = () => {
          stopped = true;
          stop();
          end(null);
        };
      });
      const all = await Promise.race([made, halted]);
      if (!all) return;
      save(`${file || 'robot'}-parts.zip`, [all.zip], 'application/zip');
      const least = all.least === null ? '' : ` No two parts come nearer than ${all.least.toFixed(2)} mm at any pose that the guard accepts.`;
      this.say('files-said', `${all.count} files.${least}`);
    } catch (error) {
      this.say('files-said', `No files are made: ${messageOf(error)}`);
    } finally {
      this.stop = null;
      bar.hidden = true;
      this.button.textContent = 'Download all files';
      if (stopped) this.say('files-said', 'Stopped; nothing was saved.');
    }
  }

  private say(id: string, text: string): void {
    const box = element(id);
    box.textContent = text;
    box.hidden = text === '';
  }
}
