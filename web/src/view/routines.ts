// The panel of routines: their steps, as in robot.toml, and a recorder that makes a routine from a drive.
import { follow } from '../follow';
import { type RobotOnFloor, type Place, type Refusal, Robot, type RoundPath, type Routine } from '../robot';
import { createRobotQueue } from '../robot-requests';
import { DriveRecorder } from '../routines/drive-recorder';
import type { Session } from '../session';
import { element, make, replaceOptions, setAttribute, setText, showMessage } from './elements';
import { isShown } from './rooms';
import type { RobotTextView } from './robot-text';
import type { BoardWriter } from './writer';

/** The first step of a new routine. */
const FIRST_STEP = 'stand 1 s';
/** Smallest width and height of the path's picture without its margin. */
const MIN_SIZE_MM = 160;
/** Margin around the path in the picture. */
const MARGIN_MM = 20;

/** Formats a number without decimals and without -0. */
const formatRounded = (value: number) => (Math.round(value) + 0).toFixed(0);

/** Returns a copy of the list with the item at the index `from` moved to the index `to`. */
function moveItem<T>(list: T[], from: number, to: number): T[] {
  const rest = list.toSpliced(from, 1);
  return rest.toSpliced(to, 0, list[from] as T);
}

export class RoutinesView {
  private readonly panel = element<HTMLDetailsElement>('routines');
  private readonly stepList = element<HTMLOListElement>('routine-steps');
  private readonly routineList = element<HTMLSelectElement>('routine');
  private readonly nameInput = element<HTMLInputElement>('routine-name');
  private readonly refusalBox = element('routine-refusal');
  private readonly pathPicture = element<HTMLElement>('routine-path') as unknown as SVGSVGElement;
  private routines: Routine[] = [];
  private recorder: DriveRecorder | null = null;
  /** The recorded steps until the user stores or drops them. */
  private recordedSteps: string[] = [];
  /** The index of the dragged step, and the index that a release now would give it; null if no step is dragged. */
  private drag: { from: number; to: number } | null = null;
  private readonly pathQueue = createRobotQueue((robot, request: RobotOnFloor & { routine: string }) => robot.simulateRound(request), (path) => this.drawPath(this.chosenRoutine && path));

  constructor(
    private readonly session: Session,
    private readonly robotText: RobotTextView,
    writer: BoardWriter,
  ) {
    const onClick = (id: string, action: () => void) => element(`routine-${id}`).addEventListener('click', action);
    this.panel.addEventListener('toggle', () => this.show());
    this.routineList.addEventListener('change', () => this.show());
    onClick('record', () => this.toggleRecording());
    onClick('keep', () => void this.storeRecorded());
    onClick('drop', () => this.offerToStore([]));
    onClick('add', () => void this.addStep());
    onClick('undo', () => void this.robotText.undo());
    onClick('start', () => void this.startRoutine());
    onClick('write', () => void this.useDraft().then((isAccepted) => isAccepted && writer.writeRobot('routine')));
    const { state } = session;
    session.robot.follow(() => this.recorder && this.toggleRecording());
    state.gait.subscribe((activity) => {
      this.recorder?.setActivity(activity, session.clock);
      this.showRecording();
    });
    state.pace.subscribe((percent) => this.recorder?.setPace(percent, session.clock));
    state.status.subscribe((status) => status && this.recorder?.setPhase(status.phase, session.clock));
    follow([state.floor, state.servos], () => this.predict());
  }

  /** Shows the text's routines, if the panel is shown. */
  show(): void {
    if (!isShown(this.panel)) return;
    this.routines = Robot.routines(this.robotText.draft);
    replaceOptions(this.routineList, this.routines.map(({ name }) => new Option(name)));
    this.routineList.disabled = this.routines.length === 0;
    this.drag = null;
    this.showSteps();
    this.predict();
  }

  /** Predicts the path of the chosen routine with its steps in the shown order. */
  private predict(): void {
    if (!isShown(this.panel)) return;
    const { chosenRoutine } = this;
    if (!chosenRoutine) return this.drawPath(null);
    const { floor, servos } = this.session.robot;
    this.pathQueue.submit({ toml: Robot.putSteps(this.robotText.draft, chosenRoutine.name, chosenRoutine.steps).text, floor, servos, routine: chosenRoutine.name });
  }

  private readonly setMessage = (text: string): void => setText(element('routine-message'), text);

  /** The chosen routine, with a dragged step at its new index; null if there is no routine. */
  private get chosenRoutine(): Routine | null {
    const chosen = this.routines.find(({ name }) => name === this.routineList.value);
    if (!chosen || !this.drag) return chosen ?? null;
    return { ...chosen, steps: moveItem(chosen.steps, this.drag.from, this.drag.to) };
  }

  /** Starts a recording, or ends the recording and offers to store its steps. */
  private toggleRecording(): void {
    const { robot, board, clock } = this.session;
    const steps = this.recorder?.listSteps(clock) ?? null;
    this.recorder = steps ? null : new DriveRecorder(robot.description.gaits, board.gait, board.pace, clock);
    const button = element('routine-record');
    button.setAttribute('aria-pressed', String(!steps));
    button.textContent = steps ? 'Record a drive' : 'Stop recording';
    this.offerToStore(steps ?? []);
    if (steps?.length === 0) this.setMessage('Nothing was recorded, because the robot did not walk.');
    this.showRecording();
  }

  /** Shows the steps recorded so far. */
  private showRecording(): void {
    if (this.recorder) this.setMessage(`Recording: ${this.recorder.listSteps(this.session.clock).join(', ') || 'drive the robot now'}`);
  }

  /** Offers to store recorded steps under a name; hides the offer if there are no steps. */
  private offerToStore(steps: string[]): void {
    this.recordedSteps = steps;
    element('routine-recorded').hidden = steps.length === 0;
    this.setMessage(steps.length === 0 ? '' : `Recorded: ${steps.join(', ')}`);
    if (steps.length === 0) return;
    const takenNames = new Set(Robot.routines(this.robotText.draft).map(({ name }) => name));
    const names = ['patrol', ...Array.from(takenNames, (_, n) => `patrol-${n + 2}`)];
    this.nameInput.value = names.find((name) => !takenNames.has(name)) ?? '';
    this.nameInput.select();
  }

  private async storeRecorded(): Promise<void> {
    const name = this.nameInput.value.trim().replaceAll(' ', '-');
    const { draft } = this.robotText;
    if (Robot.routines(draft).some((routine) => routine.name === name)) return this.setMessage(`The routine ${name} already exists; choose another name.`);
    const { text, refusal } = Robot.putSteps(draft, name, this.recordedSteps);
    // A routine with an invalid step is stored, too: the step's block shows the error.
    if (refusal && refusal.key !== `routine.${name}.steps`) return this.setMessage(refusal.reason);
    this.offerToStore([]);
    await this.robotText.loadText(text);
    this.routineList.value = name;
    this.show();
  }

  /** Appends a copy of the last step and selects its text. */
  private async addStep(): Promise<void> {
    const { steps, name } = this.chosenRoutine ?? { steps: [], name: 'patrol' };
    await this.replaceSteps([...steps, steps.at(-1) ?? FIRST_STEP], name);
    this.findInput(steps.length)?.select();
  }

  /** Replaces the steps of the routine `name`, by default the chosen routine. */
  private async replaceSteps(steps: string[], name = this.routineList.value): Promise<void> {
    this.setMessage('');
    await this.robotText.loadText(Robot.putSteps(this.robotText.draft, name, steps).text);
  }

  private async moveStep(from: number, to: number): Promise<void> {
    const { chosenRoutine } = this;
    if (!chosenRoutine || to < 0 || to >= chosenRoutine.steps.length) return;
    await this.replaceSteps(moveItem(chosenRoutine.steps, from, to));
  }

  /** Makes the shown text the robot, unless it already is; returns true if the text is accepted. */
  private async useDraft(): Promise<boolean> {
    const { draft } = this.robotText;
    return draft === this.session.robot.toml || this.robotText.loadText(draft);
  }

  private async startRoutine(): Promise<void> {
    const session = this.session;
    if (!(await this.useDraft())) return;
    // A simulated UNO restarts after each change of the robot.
    if (!session.program.isFirmwareAnswering) await session.board.waitForBanner();
    await session.board.drive(this.routineList.value.replaceAll('-', ' '));
  }

  private findInput(index: number): HTMLInputElement | null {
    return this.stepList.children[index]?.querySelector('input') ?? null;
  }

  private showSteps(): void {
    const { chosenRoutine, stepList } = this;
    const { refusal, canUndo } = this.robotText;
    const steps = chosenRoutine?.steps ?? [];
    while (stepList.children.length > steps.length) stepList.lastElementChild?.remove();
    while (stepList.children.length < steps.length) stepList.append(this.makeBlock(stepList.children.length));
    const invalidIndex = chosenRoutine && refusal?.key === `routine.${chosenRoutine.name}.steps` ? parseStepIndex(refusal) : null;
    steps.forEach((step, index) => {
      const [block, input] = [stepList.children[index], this.findInput(index)];
      if (!block || !input) return;
      if (input.value !== step) input.value = step;
      block.classList.toggle('held', this.drag?.to === index);
      input.setAttribute('aria-invalid', String(invalidIndex === index));
      setAttribute(input, 'aria-describedby', invalidIndex === index ? this.refusalBox.id : null);
    });
    showMessage(this.refusalBox, refusal?.reason ?? '');
    if (invalidIndex !== null) stepList.children[invalidIndex]?.append(this.refusalBox);
    else stepList.after(this.refusalBox);
    element<HTMLButtonElement>('routine-undo').disabled = !canUndo;
    for (const name of ['start', 'write']) element<HTMLButtonElement>(`routine-${name}`).disabled = !chosenRoutine || refusal !== null;
    element('routine-none').hidden = chosenRoutine !== null;
  }

  /** Makes the block of the step with this index: a grip, an input and buttons. */
  private makeBlock(index: number): HTMLLIElement {
    const grip = make('span', { className: 'grip', ariaHidden: 'true' }, '⠿');
    this.addDragHandlers(grip, index);
    const input = make('input', { type: 'text', spellcheck: false, autocomplete: 'off', maxLength: 63, ariaLabel: `Step ${index + 1}` });
    const block = make('li', {}, grip, input);
    input.addEventListener('change', () => void this.replaceSteps(this.chosenRoutine?.steps.with(index, input.value.trim()) ?? []));
    const addButton = (text: string, label: string, action: () => Promise<void>, nextIndex: () => number) => {
      // The focus follows the step to its new index.
      const onclick = () => void action().then(() => this.findButton(nextIndex(), label)?.focus());
      block.append(make('button', { type: 'button', ariaLabel: `${label} ${index + 1}`, onclick }, text));
    };
    addButton('↑', 'Move up step', () => this.moveStep(index, index - 1), () => Math.max(0, index - 1));
    addButton('↓', 'Move down step', () => this.moveStep(index, index + 1), () => Math.min(index + 1, this.stepList.children.length - 1));
    addButton('Copy', 'Copy step', () => this.replaceSteps(this.chosenRoutine?.steps.toSpliced(index, 0, this.chosenRoutine.steps[index] ?? '') ?? []), () => index + 1);
    addButton('×', 'Delete step', () => this.replaceSteps(this.chosenRoutine?.steps.toSpliced(index, 1) ?? []), () => Math.min(index, this.stepList.children.length - 1));
    return block;
  }

  private findButton(index: number, label: string): HTMLButtonElement | null {
    return this.stepList.children[index]?.querySelector(`[aria-label^="${label}"]`) ?? null;
  }

  /** Lets a pointer drag a step by its grip; the predicted path follows the drag. */
  private addDragHandlers(grip: HTMLElement, index: number): void {
    const findIndex = (y: number) => [...this.stepList.children].findLastIndex((block) => block.getBoundingClientRect().top <= y);
    const dragTo = (to: number) => {
      if (!this.drag || this.drag.to === to) return;
      this.drag = { from: index, to };
      this.showSteps();
      this.predict();
    };
    grip.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      grip.setPointerCapture(event.pointerId);
      this.drag = { from: index, to: index };
      this.showSteps();
    });
    grip.addEventListener('pointermove', ({ clientY }) => dragTo(Math.max(0, findIndex(clientY))));
    grip.addEventListener('pointerup', () => {
      const { drag } = this;
      this.drag = null;
      if (drag && drag.to !== index) void this.moveStep(index, drag.to);
      else this.showSteps();
    });
    grip.addEventListener('pointercancel', () => {
      dragTo(index);
      this.drag = null;
      this.showSteps();
    });
  }

  private drawPath(path: RoundPath | null): void {
    const endPlace = path?.places.at(-1) ?? null;
    this.pathPicture.toggleAttribute('hidden', endPlace === null);
    element('routine-round').textContent = path && endPlace ? describeRound(path, endPlace) : '';
    if (!path || !endPlace) return;
    const [xs, ys] = [path.places.map(({ x }) => x), path.places.map(({ y }) => -y)];
    const computeRange = (values: number[]) => {
      const [smallest, largest] = [Math.min(...values), Math.max(...values)];
      const size = Math.max(MIN_SIZE_MM, largest - smallest) + 2 * MARGIN_MM;
      return { from: (smallest + largest - size) / 2, size };
    };
    const [horizontal, vertical] = [computeRange(xs), computeRange(ys)];
    this.pathPicture.setAttribute('viewBox', `${horizontal.from} ${vertical.from} ${horizontal.size} ${vertical.size}`);
    const findPart = (name: string) => this.pathPicture.querySelector(`.${name}`);
    findPart('track')?.setAttribute('d', `M ${xs.map((x, n) => `${x.toFixed(1)} ${ys[n]?.toFixed(1)}`).join(' L ')}`);
    const size = Math.max(horizontal.size, vertical.size) / 20;
    findPart('start')?.setAttribute('r', String(size / 3));
    findPart('end')?.setAttribute('transform', `translate(${endPlace.x} ${-endPlace.y}) rotate(${-endPlace.heading}) scale(${size})`);
  }
}

/** Returns the index of the step that a refusal names; null if it names no step. */
function parseStepIndex({ reason }: Refusal): number | null {
  const stepText = /: step (\d+), /.exec(reason)?.[1];
  return stepText === undefined ? null : Number(stepText) - 1;
}

/** Returns a sentence about a round's duration and end. */
function describeRound({ seconds, is_truncated }: RoundPath, { x, y, heading }: Place): string {
  const subject = is_truncated ? `The first ${seconds.toFixed(0)} s of a round` : `A round takes ${seconds.toFixed(1)} s and`;
  const sideText = `${formatRounded(Math.abs(x))} mm to the ${x > 0 ? 'right' : 'left'}`;
  return `${subject} ${is_truncated ? 'end' : 'ends'} ${formatRounded(y)} mm ahead and ${sideText} of its start, turned by ${formatRounded(heading)}°.`;
}
