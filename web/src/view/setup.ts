// The dialog of the first connection: its steps, the current step and its view. Every step can be left and entered
// again.
import type { Guide } from '../../generated/board';
import type { Link } from '../link/link';
import { parseCalibration } from '../robot';
import type { Session } from '../session';
import { BoardGuide } from '../setup/guide';
import { messageOf } from '../trouble';
import { GAITS, NOTHING_SAVED } from '../words';
import { element } from './canvas';
import { reveal } from './rooms';
import { board } from './setup/board';
import { drawing, PLACES } from './setup/drawing';
import { firmware } from './setup/firmware';
import { horns } from './setup/horns';
import { keep } from './setup/keep';
import { Limits } from './setup/limits';
import { button, make, row, words } from './make';
import { Scale } from './setup/scale';
import { Signs } from './setup/signs';
import type { Step, Tools } from './setup/step';
import { trims } from './setup/trims';
import { walk } from './setup/walk';
import type { WriteContent, Writer } from './writer';

const STEPS: readonly Step[] = [board, firmware, horns, new Signs(), trims, new Scale(), new Limits(), walk, keep];
const LOST = 'The board is not connected any more. What was not saved is lost. Connect it again and go on here.';
const NO_ROBOT = 'No robot with this firmware answers: connect the board and write the firmware first.';

/** The dialog. Steps call its methods as plain functions, so these methods are arrow functions. */
export class Setup implements Tools {
  guide: BoardGuide | null = null;
  servo = 0;
  private step: Step = board;
  private readonly finished = new Set<string>();
  private readonly box = element('setup');
  private readonly steps = element('setup-steps');
  private readonly title = element('setup-step');
  private readonly what = element('setup-what');
  private readonly servos = element('setup-servos');
  private readonly picture = element('setup-drawing');
  private readonly message = element('setup-said');
  private readonly progress = element<HTMLProgressElement>('setup-progress');
  /** Number of actions that were begun or dropped so far: the result of an outdated action is not shown. */
  private actionCount = 0;
  private isBusy = false;
  /** True while an action runs that the dialog started by itself; the action of a button waits until it ends. */
  private isOwn = false;
  private next: (() => Promise<string>) | null = null;
  private runningAction: Promise<void> = Promise.resolve();
  private lastLink: Link | null = null;
  private wasReal = false;
  /**
   * True from the loss of a board until the next connection, or until the user goes on without it: an action that
   * began on the lost board must not continue on another one.
   */
  private isLost = false;
  /** True if the board said that it has never saved a calibration. */
  private isNew = false;

  constructor(
    private readonly sessionOf: () => Session,
    readonly writer: Writer,
    private readonly connectBoard: () => Promise<void>,
  ) {
    element('setup-open').addEventListener('click', () => this.begin());
    element('setup-leave').addEventListener('click', () => void this.leave());
    element('setup-back').addEventListener('click', () => this.moveBy(-1));
    element('setup-next').addEventListener('click', () => this.moveBy(1));
    for (const { name } of STEPS) {
      this.steps.append(make('li', {}, button(name, () => this.go(name))));
    }
    PLACES.forEach((place, servo) => {
      const choose = () => {
        this.servo = servo;
        this.message.textContent = '';
        this.show();
      };
      this.servos.append(button(`A${servo + 1} ${place}`, choose));
    });
  }

  get session(): Session {
    return this.sessionOf();
  }

  /** Opens the dialog at the step that was left, at first at the first step. */
  private begin(): void {
    this.reveal();
    this.enter(this.step);
  }

  /** True while hands may be in the robot. */
  get isOpen(): boolean {
    return !this.box.hidden;
  }

  private reveal(): void {
    this.session.letGo();
    this.box.hidden = false;
    reveal(this.box);
    element('setup-open').setAttribute('aria-expanded', 'true');
    element('setup-left').hidden = true;
  }

  /** Opens the step that a newly connected board needs first, if it needs one. */
  openNeededStep(): void {
    const { banner, hasThisRobot, link } = this.session;
    // Firmware cannot be written by radio, and a user who has added a radio module has been through these steps.
    if (link.kind === 'radio' && this.box.hidden) return;
    const step = banner === null || (banner !== 'unknown' && !hasThisRobot) ? firmware : this.isNew ? horns : null;
    if (this.box.hidden) {
      if (!step) return;
      this.step = step;
      this.reveal();
      this.enter(step);
    } else if (this.step === board && step) this.go(step.name);
    else this.enter(this.step);
  }

  /** Reads a line of the robot. */
  received(line: string): void {
    if (line.startsWith(NOTHING_SAVED)) this.isNew = true;
  }

  /** Takes the session's link. If it is another one, ends the current action. */
  link(): void {
    const { link, isReal } = this.session;
    if (link === this.lastLink) return this.update();
    const isGone = this.wasReal && !isReal;
    this.lastLink = link;
    this.wasReal = isReal;
    this.isNew = false;
    this.isLost = isGone && !this.box.hidden;
    this.drop();
    if (this.isLost) this.say(LOST);
    this.update();
  }

  /** Updates the view after a possible change of board or robot. */
  update(): void {
    if (this.guide && !this.guide.isCurrent) {
      const { isChanged } = this.guide;
      this.drop(isChanged);
      this.say(isChanged ? 'The board has restarted. What was not saved is lost.' : 'The board has restarted.');
    }
    if (!this.box.hidden && !this.isBusy) this.show();
  }

  /**
   * Drops the current action. Finished steps stay finished, unless the robot has lost its unsaved settings
   * (`isLost`).
   */
  private drop(isLost = true): void {
    this.actionCount += 1;
    this.hold(false);
    this.next = null;
    this.guide = null;
    if (isLost) this.finished.clear();
    for (const step of STEPS) step.forget?.();
  }

  /** Closes the dialog after the current action; if settings are unsaved, restores the old calibration. */
  private async leave(): Promise<void> {
    if (this.guide?.isCurrent) await this.runningAction;
    let message = '';
    const { guide } = this;
    if (guide?.isCurrent) {
      try {
        if (await guide.run((board) => board.restore())) message = 'The first connection was left: the robot has the calibration that it had before.';
      } catch (error) {
        message = `The first connection was left, and the robot may have a calibration that is not saved, until its reset: ${messageOf(error)}`;
      }
    }
    this.box.hidden = true;
    this.isLost = false;
    const opener = element('setup-open');
    opener.setAttribute('aria-expanded', 'false');
    opener.focus();
    this.drop(message !== '');
    const leaveMessage = element('setup-left');
    leaveMessage.textContent = message;
    leaveMessage.hidden = message === '';
  }

  readonly done = (step: string): void => {
    this.finished.add(step);
  };

  readonly isDone = (step: string): boolean => {
    return this.finished.has(step);
  };

  readonly connect = (): void => {
    void this.connectBoard();
  };

  readonly write = (content: WriteContent): void => {
    this.guide = null;
    this.act(async () => {
      const { message, progress } = this;
      if (await this.writer.write(content, { message, progress })) this.done('Firmware');
      return message.textContent ?? '';
    });
  };

  readonly setCalibration = (text: string, name: string): void => {
    this.act(async () => {
      const calibration = parseCalibration(text, name);
      const guide = await this.requireGuide();
      await guide.run((board) => board.replace(calibration));
      return `The robot has the calibration of ${name}. It is not saved yet.`;
    });
  };

  readonly run = (work: (guide: Guide) => Promise<string>): void => {
    this.act(async () => (await this.requireGuide()).run(work));
  };

  /** Returns the guide of the connected robot; reads the robot's calibration first if needed. */
  private async requireGuide(): Promise<BoardGuide> {
    if (this.isLost) throw new Error(LOST);
    if (!this.session.answers) throw new Error(NO_ROBOT);
    this.guide ??= await BoardGuide.begin(this.session);
    return this.guide;
  }

  /** Runs one action at a time. */
  private act(work: () => Promise<string>, isOwn = false): void {
    if (this.isBusy) {
      if (this.isOwn && !isOwn) this.next = work;
      return;
    }
    this.isOwn = isOwn;
    const actionNumber = ++this.actionCount;
    this.hold(true);
    this.say('');
    this.runningAction = work()
      .catch(messageOf)
      .then((message) => {
        if (actionNumber !== this.actionCount) return;
        this.hold(false);
        this.say(message);
        this.update();
        const { next } = this;
        this.next = null;
        if (next) this.act(next);
      });
  }

  private hold(isBusy: boolean): void {
    this.isBusy = isBusy;
    this.box.setAttribute('aria-busy', String(isBusy));
  }

  private say(text: string): void {
    this.message.textContent = text;
  }

  readonly go = (name: string): void => {
    const step = STEPS.find((candidate) => candidate.name === name);
    if (step) this.enter(step);
  };

  private moveBy(steps: number): void {
    const step = STEPS[STEPS.indexOf(this.step) + steps];
    if (step) this.enter(step);
  }

  private enter(step: Step): void {
    if (step !== this.step) {
      if (step.isByServo) this.servo = 0;
      step.forget?.();
    }
    this.step = step;
    if (!this.isBusy) this.say('');
    this.show();
    this.title.focus({ preventScroll: true });
    if (!step.needsRobot || !this.session.answers || this.isLost) return;
    // Servos that a step has turned return to neutral before the next step.
    const { guide } = this;
    if (!guide) this.act(async () => this.requireGuide().then(() => ''), true);
    else if (this.session.gait !== GAITS.stand) this.act(async () => guide.run((board) => board.stand()).then(() => ''), true);
  }

  readonly show = (): void => {
    const { step, session } = this;
    if (!session?.link) return;
    const index = STEPS.indexOf(step);
    this.steps.querySelectorAll('button').forEach((stepButton, n) => {
      stepButton.toggleAttribute('aria-current', n === index);
      if (n === index) {
        stepButton.setAttribute('aria-current', 'step');
        this.steps.scrollLeft = stepButton.offsetLeft - this.steps.offsetLeft - (this.steps.clientWidth - stepButton.offsetWidth) / 2;
      }
      stepButton.classList.toggle('done', this.isDone(STEPS[n].name));
    });
    this.title.textContent = `${index + 1} of ${STEPS.length}: ${step.title}`;
    element<HTMLButtonElement>('setup-back').disabled = index === 0;
    element<HTMLButtonElement>('setup-next').disabled = index === STEPS.length - 1;
    const isLost = this.isLost && step !== board;
    const isUsable = !isLost && (!step.needsRobot || session.answers);
    this.servos.hidden = !isUsable || !step.isByServo;
    this.servos.querySelectorAll('button').forEach((servoButton, servo) => servoButton.setAttribute('aria-pressed', String(servo === this.servo)));
    const scene = session.last?.scene ?? null;
    const drawingElement = isUsable && step.drawing && scene ? drawing(session.description, scene, step.drawing(this)) : null;
    this.picture.replaceChildren(...(drawingElement ? [drawingElement] : []));
    this.picture.hidden = !drawingElement;
    const tryOnSimulation = () => {
      this.isLost = false;
      this.enter(step);
    };
    const parts = isUsable
      ? step.parts(this)
      : [
          words(isLost ? LOST : NO_ROBOT),
          row(
            button(isLost ? 'Connect it again…' : 'To the board', isLost ? this.connect : () => this.go(board.name), true),
            ...(isLost ? [button('Try this step on the simulated UNO', tryOnSimulation)] : []),
          ),
        ];
    // The keyboard's focus stays on the same button, or goes to the next one.
    const focusedText = this.what.contains(document.activeElement) ? document.activeElement?.textContent : null;
    this.what.replaceChildren(...parts);
    if (focusedText === null) return;
    const buttons = [...this.what.querySelectorAll('button')];
    (buttons.find(({ textContent }) => textContent === focusedText) ?? this.what.querySelector<HTMLElement>('button.main') ?? this.title).focus();
  };
}
