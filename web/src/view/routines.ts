// The panel of routines: their steps, as in the text of robot.toml, and the recorder of a drive.
import { LatestQuestion } from '../latest';
import { type OnFloor, type Place, type Refused, Robot, type RoundPath, type Routine } from '../robot';
import { robotHelper } from '../robot-helper';
import { Recorder } from '../routines/recorder';
import type { Session } from '../session';
import { element } from './canvas';
import { make } from './make';
import { isShown } from './rooms';
import type { RobotText } from './robot-text';
import { NO_BOARD, type Writer } from './writer';

/** The first step of a new routine. */
const FIRST_STEP = 'stand 1 s';
/** Least width and height of the path's picture without its margin, and the margin around the path, mm. */
const LEAST_SIZE = 160;
const PICTURE_MARGIN = 20;

const formatRounded = (value: number) => (Math.round(value) + 0).toFixed(0);

/** Returns the list with the item at the index `from` moved to the index `to`. */
function moveItem<T>(list: T[], from: number, to: number): T[] {
  const rest = list.toSpliced(from, 1);
  return rest.toSpliced(to, 0, list[from] as T);
}

export class RoutinesView {
  private readonly panel = element<HTMLDetailsElement>('routines');
  private readonly list = element<HTMLOListElement>('routine-steps');
  private readonly choice = element<HTMLSelectElement>('routine');
  private readonly name = element<HTMLInputElement>('routine-name');
  private readonly refusal = element('routine-refusal');
  private readonly path = element<HTMLElement>('routine-path') as unknown as SVGSVGElement;
  private routines: Routine[] = [];
  private recorder: Recorder | null = null;
  /** The recorded steps until they are stored under a name. */
  private recorded: string[] = [];
  /** The index of the step that is dragged, and its index if it is dropped now; null without a drag. */
  private dragged: { from: number; to: number } | null = null;
  private paths: LatestQuestion<OnFloor & { routine: string }, RoundPath | null> | null = null;

  /** `pace` returns the pace, percent, and `ask` sends a line. */
  constructor(
    private readonly module: WebAssembly.Module,
    private readonly session: () => Session,
    private readonly text: RobotText,
    private readonly pace: () => number,
    private readonly ask: (line: string) => Promise<void>,
    private readonly writer: Writer,
  ) {
    const onClick = (id: string, act: () => void) => element(`routine-${id}`).addEventListener('click', act);
    this.panel.addEventListener('toggle', () => this.show());
    this.choice.addEventListener('change', () => this.show());
    onClick('record', () => this.record());
    onClick('keep', () => void this.keep());
    onClick('drop', () => this.offer([]));
    onClick('add', () => void this.add());
    onClick('undo', () => void this.text.undoLast());
    onClick('start', () => void this.start());
    onClick('write', () => void this.write());
  }

  /** Takes another robot, which ends a recording. */
  showRobot(): void {
    if (this.recorder) this.record();
  }

  /** Takes the robot's activity. */
  doing(gait: string): void {
    this.recorder?.setGait(gait, this.session().clock);
    this.showRecording();
  }

  /** Takes the robot's pace, percent. */
  speed(percent: number): void {
    this.recorder?.setPace(percent, this.session().clock);
  }

  /** Takes the phase of the robot's gait. */
  phase(phase: number): void {
    this.recorder?.setPhase(phase, this.session().clock);
  }

  /** Shows the routines of the text, if the panel is open. */
  show(): void {
    if (!isShown(this.panel)) return;
    const { value } = this.choice;
    this.routines = Robot.routines(this.text.draft);
    this.choice.replaceChildren(...this.routines.map(({ name }) => new Option(name)));
    if (this.routines.some(({ name }) => name === value)) this.choice.value = value;
    this.choice.disabled = this.routines.length === 0;
    this.dragged = null;
    this.showSteps();
    this.predict();
  }

  /** Predicts the path of the chosen routine with its steps as they are shown. */
  predict(): void {
    if (!isShown(this.panel)) return;
    const { shown } = this;
    if (!shown) return this.draw(null);
    const { floor, servos } = this.session();
    this.paths ??= this.makePathQuestion();
    this.paths.ask({ toml: Robot.putSteps(this.text.draft, shown.name, shown.steps).text, floor, servos, routine: shown.name });
  }

  private makePathQuestion(): NonNullable<typeof this.paths> {
    const helper = robotHelper(this.module);
    return new LatestQuestion((question) => helper.ask((robot) => robot.round(question)), (path) => this.draw(path));
  }

  private say(text: string): void {
    element('routine-said').textContent = text;
  }

  /** The chosen routine, with its steps in the order in which they are dragged. */
  private get shown(): Routine | null {
    const chosen = this.routines.find(({ name }) => name === this.choice.value);
    if (!chosen || !this.dragged) return chosen ?? null;
    return { ...chosen, steps: moveItem(chosen.steps, this.dragged.from, this.dragged.to) };
  }

  private record(): void {
    const { description, gait, clock } = this.session();
    const steps = this.recorder?.steps(clock) ?? null;
    this.recorder = steps ? null : new Recorder(description.gaits, gait, this.pace(), clock);
    const button = element('routine-record');
    button.setAttribute('aria-pressed', String(!steps));
    button.textContent = steps ? 'Record a drive' : 'Stop recording';
    this.offer(steps ?? []);
    if (steps?.length === 0) this.say('Nothing is recorded: the robot has not walked.');
    this.showRecording();
  }

  /** Shows the steps recorded so far. */
  private showRecording(): void {
    if (this.recorder) this.say(`Recording: ${this.recorder.steps(this.session().clock).join(', ') || 'drive now'}`);
  }

  /** Offers to store recorded steps under a name; without steps, hides the offer. */
  private offer(steps: string[]): void {
    this.recorded = steps;
    element('routine-recorded').hidden = steps.length === 0;
    this.say(steps.length === 0 ? '' : `Recorded: ${steps.join(', ')}`);
    if (steps.length === 0) return;
    const takenNames = new Set(Robot.routines(this.text.draft).map(({ name }) => name));
    const names = ['patrol', ...Array.from(takenNames, (_, n) => `patrol-${n + 2}`)];
    this.name.value = names.find((name) => !takenNames.has(name)) ?? '';
    this.name.select();
  }

  private async keep(): Promise<void> {
    const name = this.name.value.trim().replaceAll(' ', '-');
    const { draft } = this.text;
    if (Robot.routines(draft).some((routine) => routine.name === name)) return this.say(`${name} is there already: give it another name.`);
    const { text, refusal } = Robot.putSteps(draft, name, this.recorded);
    // With a mistake in a step the routine is stored anyway: its block shows the mistake.
    if (refusal && refusal.key !== `routine.${name}.steps`) return this.say(refusal.refused);
    this.offer([]);
    await this.text.loadText(text);
    this.choice.value = name;
    this.show();
  }

  private async add(): Promise<void> {
    const { steps, name } = this.shown ?? { steps: [], name: 'patrol' };
    await this.change([...steps, steps.at(-1) ?? FIRST_STEP], name);
    this.inputAt(steps.length)?.select();
  }

  /** Replaces the steps of the chosen routine. */
  private async change(steps: string[], name = this.choice.value): Promise<void> {
    this.say('');
    await this.text.loadText(Robot.putSteps(this.text.draft, name, steps).text);
  }

  private async move(from: number, to: number): Promise<void> {
    const { shown } = this;
    if (!shown || to < 0 || to >= shown.steps.length) return;
    await this.change(moveItem(shown.steps, from, to));
  }

  private async start(): Promise<void> {
    const session = this.session();
    // A simulated UNO restarts with each change.
    if (!session.answers) await session.greeting();
    await this.ask(this.choice.value.replaceAll('-', ' '));
  }

  private async write(): Promise<void> {
    const message = element('routine-said');
    if (!this.session().isReal) this.say(NO_BOARD);
    else await this.writer.write('robot', { message, progress: element<HTMLProgressElement>('routine-progress') });
  }

  private inputAt(index: number): HTMLInputElement | null {
    return this.list.children[index]?.querySelector('input') ?? null;
  }

  private showSteps(): void {
    const { shown, list } = this;
    const { refused, canUndo } = this.text;
    const steps = shown?.steps ?? [];
    while (list.children.length > steps.length) list.lastElementChild?.remove();
    while (list.children.length < steps.length) list.append(this.makeBlock(list.children.length));
    const mistakenIndex = shown && refused?.key === `routine.${shown.name}.steps` ? mistakenStepOf(refused) : null;
    steps.forEach((step, index) => {
      const [block, input] = [list.children[index], this.inputAt(index)];
      if (!block || !input) return;
      if (input.value !== step) input.value = step;
      block.classList.toggle('held', this.dragged?.to === index);
      input.setAttribute('aria-invalid', String(mistakenIndex === index));
      if (mistakenIndex === index) input.setAttribute('aria-describedby', this.refusal.id);
      else input.removeAttribute('aria-describedby');
    });
    this.refusal.hidden = refused === null;
    this.refusal.textContent = refused?.refused ?? '';
    if (mistakenIndex !== null) list.children[mistakenIndex]?.append(this.refusal);
    else list.after(this.refusal);
    element<HTMLButtonElement>('routine-undo').disabled = !canUndo;
    for (const name of ['start', 'write']) element<HTMLButtonElement>(`routine-${name}`).disabled = !shown || refused !== null;
    element('routine-none').hidden = shown !== null;
  }

  /** Makes the block of the step at an index. */
  private makeBlock(index: number): HTMLLIElement {
    const grip = make('span', { className: 'grip', ariaHidden: 'true' }, '⠿');
    this.drag(grip, index);
    const input = make('input', { type: 'text', spellcheck: false, autocomplete: 'off', maxLength: 63, ariaLabel: `Step ${index + 1}` });
    const block = make('li', {}, grip, input);
    input.addEventListener('change', () => void this.change(this.shown?.steps.with(index, input.value.trim()) ?? []));
    const addButton = (text: string, label: string, act: () => Promise<void>, nextIndex: () => number) => {
      const buttonElement = make('button', { type: 'button', ariaLabel: `${label} ${index + 1}` }, text);
      block.append(buttonElement);
      // The focus follows the step to its new index.
      buttonElement.addEventListener('click', () => void act().then(() => this.findButton(nextIndex(), label)?.focus()));
    };
    addButton('↑', 'Move up step', () => this.move(index, index - 1), () => Math.max(0, index - 1));
    addButton('↓', 'Move down step', () => this.move(index, index + 1), () => Math.min(index + 1, this.list.children.length - 1));
    addButton('Copy', 'Copy step', () => this.change(this.shown?.steps.toSpliced(index, 0, this.shown.steps[index] ?? '') ?? []), () => index + 1);
    addButton('×', 'Delete step', () => this.change(this.shown?.steps.toSpliced(index, 1) ?? []), () => Math.min(index, this.list.children.length - 1));
    return block;
  }

  private findButton(index: number, label: string): HTMLButtonElement | null {
    return this.list.children[index]?.querySelector(`[aria-label^="${label}"]`) ?? null;
  }

  /** Lets a pointer drag a step by its grip to another index; the predicted path follows. */
  private drag(grip: HTMLElement, index: number): void {
    const indexAt = (y: number) => [...this.list.children].findLastIndex((block) => block.getBoundingClientRect().top <= y);
    const dragTo = (to: number) => {
      if (!this.dragged || this.dragged.to === to) return;
      this.dragged = { from: index, to };
      this.showSteps();
      this.predict();
    };
    grip.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      grip.setPointerCapture(event.pointerId);
      this.dragged = { from: index, to: index };
      this.showSteps();
    });
    grip.addEventListener('pointermove', ({ clientY }) => dragTo(Math.max(0, indexAt(clientY))));
    grip.addEventListener('pointerup', () => {
      const { dragged } = this;
      this.dragged = null;
      if (dragged && dragged.to !== index) void this.move(index, dragged.to);
      else this.showSteps();
    });
    grip.addEventListener('pointercancel', () => {
      dragTo(index);
      this.dragged = null;
      this.showSteps();
    });
  }

  private draw(path: RoundPath | null): void {
    const endPlace = path?.places.at(-1) ?? null;
    this.path.toggleAttribute('hidden', endPlace === null);
    element('routine-round').textContent = path && endPlace ? describeRound(path, endPlace) : '';
    if (!path || !endPlace) return;
    const [xs, ys] = [path.places.map(({ x }) => x), path.places.map(({ y }) => -y)];
    const rangeOf = (values: number[]) => {
      const [smallest, largest] = [Math.min(...values), Math.max(...values)];
      const size = Math.max(LEAST_SIZE, largest - smallest) + 2 * PICTURE_MARGIN;
      return { from: (smallest + largest - size) / 2, size };
    };
    const [horizontal, vertical] = [rangeOf(xs), rangeOf(ys)];
    this.path.setAttribute('viewBox', `${horizontal.from} ${vertical.from} ${horizontal.size} ${vertical.size}`);
    const findPart = (name: string) => this.path.querySelector(`.${name}`);
    findPart('track')?.setAttribute('d', `M ${xs.map((x, n) => `${x.toFixed(1)} ${ys[n]?.toFixed(1)}`).join(' L ')}`);
    const size = Math.max(horizontal.size, vertical.size) / 20;
    findPart('start')?.setAttribute('r', String(size / 3));
    findPart('end')?.setAttribute('transform', `translate(${endPlace.x} ${-endPlace.y}) rotate(${-endPlace.heading}) scale(${size})`);
  }
}

/** Returns the index of the step that a refusal names; null if it names none. */
function mistakenStepOf({ refused }: Refused): number | null {
  const stepText = /: step (\d+), /.exec(refused)?.[1];
  return stepText === undefined ? null : Number(stepText) - 1;
}

function describeRound({ seconds, is_cut }: RoundPath, { x, y, heading }: Place): string {
  const subject = is_cut ? `The first ${seconds.toFixed(0)} s of a round` : `A round takes ${seconds.toFixed(1)} s and`;
  const sideText = `${formatRounded(Math.abs(x))} mm to the ${x > 0 ? 'right' : 'left'}`;
  return `${subject} ${is_cut ? 'end' : 'ends'} ${formatRounded(y)} mm ahead and ${sideText} of its start, turned by ${formatRounded(heading)}°.`;
}
