// The room in which a camera measures the robot: the camera's picture, the page's protocol or the user's own film,
// and the results.
import { transfer } from 'comlink';

import type { AskedWalk } from '../../generated/measure';
import { files } from '../files';
import { Helper } from '../helper';
import { MIN_CYCLES, Interrupted, Protocol, type Walk } from '../measure/protocol';
import { TagTracker } from '../measure/seen';
import { Source } from '../measure/source';
import type { FilmFunctions } from '../measure/worker';
import type { Description, Gait, GaitPrediction } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { WORDS } from '../words';
import { element } from './canvas';
import { save } from './download';
import { make } from './make';
import { Measured } from './measured';
import { numberInput, putNumber, type Range } from './number';
import { OPENED } from './rooms';
import { drawSight } from './sight';

/** Least displacement per cycle of a gait that is ticked by default: mm ahead or deg of turn. */
const LEAST_DISPLACEMENT = { way: 3, turn: 2 };
const NUMBERS: Record<string, Range & { value: number | null }> = {
  speed: { min: 10, max: 100, step: 5, value: 100 },
  cycles: { min: MIN_CYCLES, max: 50, step: 1, value: 8 },
  pause: { min: 0.5, max: 30, step: 0.5, value: 1 },
  height: { min: 0, max: 500, step: 0.5, value: null },
  ruler: { min: 85, max: 115, step: 0.1, value: 100 },
};

/**
 * `record` keeps the camera's pictures until the user is done, `drive` keeps them while the page drives, `play` reads
 * a film file, `compute` measures the walks in the pictures.
 */
type Doing = 'nothing' | 'record' | 'drive' | 'play' | 'compute';

type Film = Helper<FilmFunctions>;

async function loadFilm(): Promise<Film> {
  const module = await files.measure();
  const film: Film = new Helper(new Worker(new URL('../measure/worker.ts', import.meta.url), { type: 'module' }));
  await film.ask((functions) => functions.load(module));
  return film;
}

export class MeasureView {
  private readonly room = element('room-measure');
  private readonly view = element('measure-view');
  private readonly driver = element<HTMLSelectElement>('measure-driver');
  private readonly gait = element<HTMLSelectElement>('measure-gait');
  private readonly boxes = element('measure-gaits');
  private readonly startButton = element<HTMLButtonElement>('measure-start');
  private readonly cameraButton = element<HTMLButtonElement>('measure-camera');
  private readonly goButton = element<HTMLButtonElement>('measure-go');
  private readonly values: Record<string, number | null> = {};
  private readonly measured: Measured;
  private readonly source: Source;
  private film: Promise<Film> | null = null;
  private seen = new TagTracker();
  private doing: Doing = 'nothing';
  private protocol: Protocol | null = null;
  /** True while the user puts the robot back by hand; pictures of that are not kept. */
  private isPutBack = false;
  /** True if a film file was read, whose pictures can be measured again. */
  private hasFilm = false;
  /** The gaits that the user has ticked (true) or unticked (false). */
  private readonly ticked = new Map<string, boolean>();

  /**
   * `choices` returns the gaits predicted so far; `isBarred` returns true while the set-up is open: hands may be in
   * the robot, which must not be driven.
   */
  constructor(
    private readonly session: () => Session,
    private readonly choices: () => { command: string; displacement: GaitPrediction }[],
    private readonly isBarred: () => boolean,
  ) {
    this.measured = new Measured(() => this.session().description.name);
    const video = this.view.querySelector('video');
    if (!video) throw new Error('the page has no video for the camera');
    this.source = new Source(video, (picture, seconds) => this.look(picture, seconds));
    for (const [name, { value, ...range }] of Object.entries(NUMBERS)) {
      const input = element<HTMLInputElement>(`measure-${name}`);
      this.values[name] = value;
      numberInput(input, range, (typed) => (this.values[name] = typed ?? value));
      if (value !== null) putNumber(input, value);
    }
    this.cameraButton.addEventListener('click', () => void this.runAction(() => this.toggleCamera()));
    element('measure-file').addEventListener('change', ({ target }) => {
      const file = (target as HTMLInputElement).files?.[0];
      if (file) void this.runAction(() => this.play(file));
    });
    element('measure-sheet').addEventListener('click', () => void this.runAction(() => this.saveSheet()));
    this.startButton.addEventListener('click', () => void this.runAction(() => this.start()));
    this.driver.addEventListener('change', () => this.show());
    document.addEventListener(OPENED, () => this.room.hidden && this.leave());
    this.show();
  }

  /** Ends driving, and lists the gaits of a newly chosen robot. */
  showRobot({ gaits }: Description): void {
    this.stop('another robot was chosen');
    const movingCommands = gaits.filter(({ moves }) => moves).map(({ command }) => command);
    const chosen = this.gait.value;
    this.gait.replaceChildren(new Option('found by its path', ''), ...gaits.filter(({ moves }) => moves).map(({ command, name }) => new Option(command, name)));
    if ([...this.gait.options].some(({ value }) => value === chosen)) this.gait.value = chosen;
    this.boxes.replaceChildren(
      make('legend', {}, 'Gaits'),
      ...movingCommands.map((command) => {
        const box = make('input', { type: 'checkbox', name: command, onchange: () => this.ticked.set(command, box.checked) });
        return make('label', { className: 'check' }, box, ` ${command}`);
      }),
    );
    this.predicted();
  }

  /** Ticks the gaits with a displacement, as far as predicted; the user's own ticks stay. */
  predicted(): void {
    const hasDisplacement = new Map(this.choices().map(({ command, displacement: { forward, turn } }) => [command, Math.abs(forward ?? 0) >= LEAST_DISPLACEMENT.way || Math.abs(turn ?? 0) >= LEAST_DISPLACEMENT.turn]));
    for (const box of this.boxes.querySelectorAll('input')) box.checked = this.ticked.get(box.name) ?? hasDisplacement.get(box.name) ?? false;
  }

  /** Ends driving for an external reason, and stops the robot. */
  stop(reason: string): void {
    this.protocol?.stop(reason);
  }

  /** Ends driving after a change of the link, and preselects the page as the driver of a real robot. */
  link(isReal: boolean): void {
    this.protocol?.end('the link to the robot has changed');
    this.driver.value = isReal ? 'page' : 'other';
    this.show();
  }

  /** Takes a line that was sent to the robot. */
  sent(line: string): void {
    this.protocol?.sent(line);
  }

  received(line: string): void {
    this.protocol?.received(line);
  }

  did(activity: string): void {
    this.protocol?.setActivity(activity);
  }

  /** Updates the text about the last pictures; called several times per second. */
  write(): void {
    if (this.room.hidden || this.view.hidden) return;
    const { rate, trouble, ms } = this.seen;
    this.setText('measure-rate', `${rate.toFixed(0)} pictures a second, each looked at in ${ms.toFixed(0)} ms`);
    this.setText('measure-seen', trouble || 'All five tags are seen.');
    element('measure-seen').classList.toggle('refusal', trouble !== '');
  }

  private getFilm(): Promise<Film> {
    this.film ??= loadFilm();
    this.film.catch(() => (this.film = null));
    return this.film;
  }

  /** Runs an action that the user has asked for; shows the reason if it fails. */
  private async runAction(act: () => Promise<void>): Promise<void> {
    try {
      await act();
    } catch (error) {
      this.say(messageOf(error), true);
    } finally {
      this.show();
    }
  }

  private async toggleCamera(): Promise<void> {
    if (this.source.isCamera) {
      this.leave();
      return this.say('');
    }
    this.say('Opening the camera…');
    this.hasFilm = false;
    await this.getFilm();
    await this.source.camera(() => {
      this.leave();
      this.say('The camera is gone.', true);
      this.show();
    });
    this.seen = new TagTracker();
    this.say('Place the camera so that all five tags are seen.');
  }

  /** Switches the camera off and ends the activity that uses it. */
  private leave(): void {
    this.stop('the camera was switched off');
    this.source.stop();
    if (this.doing !== 'compute') this.doing = 'nothing';
    this.show();
  }

  private async look(picture: VideoFrame | ImageBitmap, seconds: number): Promise<void> {
    const film = await this.getFilm();
    const isKept = this.doing === 'record' || this.doing === 'play' || (this.doing === 'drive' && !this.isPutBack);
    try {
      this.seen.take(await film.ask((film) => film.look(transfer(picture, [picture]), seconds, isKept)));
      this.protocol?.setPlace(this.seen.back);
      drawSight(this.view.querySelector('canvas') as HTMLCanvasElement, this.seen);
    } catch (error) {
      this.say(messageOf(error), true);
    }
  }

  private async play(file: File): Promise<void> {
    this.leave();
    const film = await this.getFilm();
    await film.ask((film) => film.clear());
    this.seen = new TagTracker();
    this.doing = 'play';
    this.hasFilm = false;
    this.say(`Reading ${file.name}…`);
    this.show();
    try {
      await this.source.file(file);
      if (this.doing !== 'play') return;
      this.hasFilm = true;
      await this.compute(this.wholeFilm);
    } finally {
      this.doing = 'nothing';
    }
  }

  /** The chosen gait in the whole film as one walk; empty if the gaits are to be recognized by their paths. */
  private get wholeFilm(): AskedWalk[] {
    const gait = this.gait.value;
    return gait === '' ? [] : [{ gait, during: null }];
  }

  /** Acts as the start button says: starts or ends recording or driving, or measures the film file again. */
  private async start(): Promise<void> {
    if (this.doing === 'record') return this.compute(this.wholeFilm);
    if (this.doing === 'drive') return void this.session().ask(WORDS.stop);
    if (this.hasFilm) return this.compute(this.wholeFilm);
    const isPage = this.driver.value === 'page';
    const gaits = isPage ? this.drivableGaits() : [];
    const film = await this.getFilm();
    await film.ask((film) => film.clear());
    this.seen.clear();
    if (isPage) return this.drive(gaits);
    this.doing = 'record';
    this.say('Recording. Let the robot walk at least four cycles, then press Done.');
  }

  /** Returns the ticked gaits. Throws the reason why the page cannot drive. */
  private drivableGaits(): Gait[] {
    const session = this.session();
    const ticked = [...this.boxes.querySelectorAll('input')].filter(({ checked }) => checked).map(({ name }) => name);
    const gaits = session.description.gaits.filter(({ command }) => ticked.includes(command));
    if (this.isBarred()) throw new Error('Hands may be in the robot: leave the set-up first.');
    if (session.otherRobot) throw new Error(`The board has another robot, ${session.otherRobot.name}: choose that one, or write this one to the board.`);
    if (!session.answers) throw new Error(`No robot answers from the ${session.link.name}.`);
    if (gaits.length === 0) throw new Error('Tick at least one gait.');
    return gaits;
  }

  private async drive(gaits: Gait[]): Promise<void> {
    const session = this.session();
    const { cycles, pause } = this.values;
    const speed = this.values.speed ?? 100;
    const protocol = new Protocol({
      ask: async (line) => (await session.ask(line))?.ok === true,
      now: () => this.source.now,
      wait: (seconds) => session.link.wait(1000 * seconds),
      ways: () => this.choices().map(({ command, displacement: { forward, turn } }) => ({ command, forward: forward ?? 0, turn: turn ?? Infinity })),
      putBack: () => this.putBack(protocol),
      say: (text) => this.say(text),
    });
    this.protocol = protocol;
    protocol.setPlace(this.seen.back);
    this.doing = 'drive';
    this.show();
    try {
      await protocol.run({ gaits, cycles: cycles ?? 8, speed, pause: pause ?? 1 });
      await this.compute(this.withGaitNames(protocol.walks), speed);
    } catch (error) {
      if (!(error instanceof Interrupted) || protocol.walks.length === 0) throw error;
      await this.compute(this.withGaitNames(protocol.walks), speed, [`Ended before all gaits were walked: ${error.message}`]);
    } finally {
      this.protocol = null;
      this.isPutBack = false;
      this.doing = 'nothing';
      this.goButton.hidden = true;
    }
  }

  /** Converts walks: their gaits' commands become the names in robot.toml. */
  private withGaitNames(walks: Walk[]): AskedWalk[] {
    const { gaits } = this.session().description;
    return walks.map(({ gait, during }) => ({ gait: gaits.find(({ command }) => command === gait)?.name ?? gait, during }));
  }

  private async putBack(protocol: Protocol): Promise<void> {
    this.isPutBack = true;
    this.goButton.hidden = false;
    this.say('The robot is near the end of what the camera measures, or its tag is hidden: put it back to the middle of the strips, and press the button.', true);
    await new Promise<void>((resolve) => {
      this.goButton.onclick = () => resolve();
      protocol.onEnd = resolve;
    });
    this.goButton.hidden = true;
    this.isPutBack = false;
  }

  /** Measures walks in the film; shows the results, `troubles` and the reasons why walks could not be measured. */
  private async compute(walks: AskedWalk[], speed = this.values.speed ?? 100, troubles: string[] = []): Promise<void> {
    this.doing = 'compute';
    this.say('Measuring…');
    this.show();
    const film = await this.getFilm();
    const { height = null, ruler } = this.values;
    try {
      const results = await film.ask((film) => film.measure({ toml: this.session().toml, speed, height, ruler: ruler ?? 100, walks }));
      this.measured.show(results.gaits);
      troubles.push(...results.troubles);
    } catch (error) {
      this.measured.show([]);
      troubles.push(messageOf(error));
    }
    this.doing = 'nothing';
    this.say(troubles.map((trouble) => `${trouble}.`).join(' '), true);
  }

  private async saveSheet(): Promise<void> {
    const isLetter = element<HTMLSelectElement>('measure-paper').value === 'letter';
    const film = await this.getFilm();
    save('sheet.pdf', [await film.ask((film) => film.sheet(isLetter))], 'application/pdf');
    this.say('sheet.pdf: print it at 100 % ("actual size"), then measure the line of 100 mm on it.');
  }

  /** Shows the controls that can be used now. */
  private show(): void {
    const { doing, source, hasFilm } = this;
    const isPage = this.driver.value === 'page' && !hasFilm;
    this.view.hidden = !source.isCamera && doing !== 'play';
    element('measure-rate').hidden = element('measure-seen').hidden = this.view.hidden;
    this.cameraButton.setAttribute('aria-pressed', String(source.isCamera));
    element('measure-one').hidden = isPage;
    this.boxes.hidden = !isPage;
    for (const label of this.room.querySelectorAll<HTMLElement>('[data-driver]')) label.hidden = !isPage;
    this.startButton.textContent = doing === 'record' ? 'Done' : doing === 'drive' ? 'Stop' : hasFilm ? 'Measure again' : isPage ? 'Drive and measure' : 'Record';
    this.startButton.disabled = doing === 'play' || doing === 'compute' || (!source.isCamera && !hasFilm);
    this.driver.disabled = doing !== 'nothing';
  }

  private say(text: string, isTrouble = false): void {
    this.setText('measure-said', text);
    element('measure-said').classList.toggle('refusal', isTrouble && text !== '');
  }

  private setText(id: string, text: string): void {
    const box = element(id);
    if (box.textContent !== text) box.textContent = text;
  }
}
