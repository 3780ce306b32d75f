// The dialog of the first connection, which sets up a new robot step by step. The user can enter and leave the steps in
// any order.
import type { Calibrator } from '../../generated/board';
import { follow } from '../follow';
import type { Link } from '../link/link';
import { parseCalibration } from '../robot';
import type { Session } from '../session';
import { BoardCalibrator } from '../setup/board-calibrator';
import { getMessage } from '../problem';
import { STAND, NOTHING_SAVED_LINE } from '../words';
import { reveal } from './rooms';
import { boardStep } from './setup/board';
import { makeDrawing, SERVO_POSITIONS } from './setup/drawing';
import { firmwareStep } from './setup/firmware';
import { hornsStep } from './setup/horns';
import { keepStep } from './setup/keep';
import { limitsStep } from './setup/limits';
import { button, element, make, paragraph, row, setAttribute, setText, showMessage } from './elements';
import { scaleStep } from './setup/scale';
import { signsStep } from './setup/signs';
import type { Step, Turn } from './setup/step';
import { trimsStep } from './setup/trims';
import { walkStep } from './setup/walk';
import type { WriteContent, BoardWriter } from './writer';

const STEPS: readonly Step[] = [boardStep, firmwareStep, hornsStep, signsStep, trimsStep, scaleStep, limitsStep, walkStep, keepStep];
const LOST_MESSAGE = 'The board is no longer connected. Unsaved settings are lost. Connect it again and continue here.';
const NO_ROBOT_MESSAGE = 'No robot with this firmware answers: connect the board and write the firmware first.';

/** The dialog. The steps call its methods as plain functions; therefore these methods are arrow functions. */
export class SetupDialog {
  /** The calibrator for the connected robot; null until its calibration is read. */
  calibrator: BoardCalibrator | null = null;
  /** The selected servo, 0 to 3. */
  servo = 0;
  /** The last turn of a servo; null once the servos stand, and in a new step. */
  lastTurn: Turn | null = null;
  private step: Step = boardStep;
  /** The names of the finished steps, and the keys of the finished parts of steps. */
  private readonly doneSteps = new Set<string>();
  private readonly dialog = element('setup');
  private readonly stepList = element('setup-steps');
  private readonly title = element('setup-step');
  private readonly content = element('setup-content');
  private readonly servoButtons = element('setup-servos');
  private readonly drawingBox = element('setup-drawing');
  private readonly message = element('setup-message');
  /** Number of started or dropped actions so far; identifies the result of an outdated action. */
  private actionCount = 0;
  private isBusy = false;
  /** True if the dialog itself started the running action; a button's action then waits until it ends. */
  private isAutomatic = false;
  /** The button's action that starts after the running action; null for none. */
  private queuedAction: (() => Promise<string>) | null = null;
  /** Settles at the end of the last action. */
  private runningAction: Promise<void> = Promise.resolve();
  private lastLink: Link | null = null;
  private wasBoardReal = false;
  /**
   * True from the loss of a board until the next connection, or until the user continues without the board: an action
   * that started on the lost board must not continue on another board.
   */
  private isLost = false;
  /** True if the board has reported that it has no saved calibration. */
  private isUncalibrated = false;
  /** True while the dialog is being closed; no action may start meanwhile, because it would move a servo afterwards. */
  private isLeaving = false;

  constructor(
    readonly session: Session,
    private readonly writer: BoardWriter,
    private readonly toggleBoard: () => Promise<void>,
  ) {
    element('setup-open').addEventListener('click', () => this.open(this.step));
    element('setup-leave').addEventListener('click', () => void this.leave());
    element('setup-back').addEventListener('click', () => this.moveBy(-1));
    element('setup-next').addEventListener('click', () => this.moveBy(1));
    for (const { name } of STEPS) this.stepList.append(make('li', {}, button(name, () => this.goTo(name))));
    SERVO_POSITIONS.forEach((place, servo) => {
      const choose = () => {
        this.servo = servo;
        this.message.textContent = '';
        this.redraw();
      };
      this.servoButtons.append(button(`A${servo + 1} ${place}`, choose));
    });
    const { link, banner, bannerCount, description } = session.state;
    // Each restart of the robot changes the number of banners.
    follow([link, banner, bannerCount, description, writer.isBusy], () => link.value && this.followLink());
  }

  /** The last turn in this step if the selected servo has turned; null otherwise. */
  get currentTurn(): Turn | null {
    const { lastTurn } = this;
    return lastTurn?.step === this.step && lastTurn.servo === this.servo ? lastTurn : null;
  }

  /** True while the dialog is open; the user's hands may then be in the robot. */
  get isOpen(): boolean {
    return !this.dialog.hidden;
  }

  private open(step: Step): void {
    this.session.board.stopIfWalking();
    this.dialog.hidden = false;
    reveal(this.dialog);
    element('setup-open').setAttribute('aria-expanded', 'true');
    element('setup-left').hidden = true;
    this.enterStep(step);
  }

  /** Opens the first step that a newly connected board needs, if any. */
  openNeededStep(): void {
    const { banner, link } = this.session.board;
    const { hasThisRobot } = this.session.program;
    // A radio cannot write, and a user with a radio module has already finished these steps.
    if (link.kind === 'radio' && this.dialog.hidden) return;
    const step = banner === null || (banner !== 'unknown' && !hasThisRobot) ? firmwareStep : this.isUncalibrated ? hornsStep : null;
    if (this.dialog.hidden) {
      if (step) this.open(step);
    } else this.enterStep(this.step === boardStep && step ? step : this.step);
  }

  /** Handles a line that the page has sent to the robot: the panel Calibrate and the console also change settings. */
  handleSent(line: string): void {
    this.calibrator?.handleSent(line);
  }

  /** Evaluates a line from the robot. */
  handleReceived(line: string): void {
    if (line.startsWith(NOTHING_SAVED_LINE)) this.isUncalibrated = true;
  }

  /** Updates the view for the session's link; drops the current action if the link is new. */
  private followLink(): void {
    const { link, isReal } = this.session.board;
    if (link === this.lastLink) return this.update();
    const isGone = this.wasBoardReal && !isReal;
    this.lastLink = link;
    this.wasBoardReal = isReal;
    this.isUncalibrated = false;
    this.isLost = isGone && !this.dialog.hidden;
    this.dropAction();
    if (this.isLost) this.setMessage(LOST_MESSAGE);
    this.update();
  }

  /** Updates the view after a possible change of board or robot. */
  private update(): void {
    if (this.calibrator && !this.calibrator.isCurrent) {
      const { isChanged } = this.calibrator;
      this.dropAction(isChanged);
      this.setMessage(isChanged ? 'The board has restarted. Unsaved settings are lost.' : 'The board has restarted.');
    }
    if (!this.dialog.hidden && !this.isBusy) this.redraw();
  }

  /** Drops the current action. If `areSettingsLost`, finished steps are no longer finished. */
  private dropAction(areSettingsLost = true): void {
    this.actionCount += 1;
    this.setBusy(false);
    this.queuedAction = null;
    this.calibrator = null;
    if (areSettingsLost) this.doneSteps.clear();
    this.lastTurn = null;
  }

  /** Closes the dialog after the current action; restores the previous calibration if settings are unsaved. */
  private async leave(): Promise<void> {
    if (this.isLeaving) return;
    this.isLeaving = true;
    if (this.calibrator?.isCurrent) await this.runningAction.catch(() => {});
    let message = '';
    const { calibrator } = this;
    if (calibrator?.isCurrent) {
      try {
        if (await calibrator.run((calibrator) => calibrator.restore())) message = 'You have left the first connection; the robot has its previous calibration.';
      } catch (error) {
        message = `You have left the first connection; the robot may have an unsaved calibration until its next reset: ${getMessage(error)}`;
      }
    }
    this.dialog.hidden = true;
    this.isLeaving = false;
    this.isLost = false;
    const opener = element('setup-open');
    opener.setAttribute('aria-expanded', 'false');
    opener.focus();
    this.dropAction(message !== '');
    showMessage(element('setup-left'), message);
  }

  /** Marks a step, or a part of a step, as done. */
  readonly markDone = (step: string): void => void this.doneSteps.add(step);

  /** Returns true if a step, or a part of a step, is done. */
  readonly isDone = (step: string): boolean => this.doneSteps.has(step);

  /** Connects a board on USB, or disconnects a board, unless the boot loader uses the line. */
  readonly toggleConnection = (): void => void (this.writer.isBusy.value || this.toggleBoard());

  /** Writes the page's robot, alone or with the firmware. */
  readonly write = (content: WriteContent): void => {
    this.runAction(async () => {
      const { calibrator } = this;
      const { board } = this.session;
      const { banner } = board;
      this.calibrator = null;
      const isWritten = await this.writer.write(content, 'setup');
      const mayHaveRestarted = isWritten || board.banner !== banner;
      // A restart loses unsaved settings: a reversed sign, for example, is wrong again.
      if (mayHaveRestarted && calibrator?.isChanged) this.doneSteps.clear();
      if (!mayHaveRestarted && calibrator?.isCurrent) this.calibrator = calibrator;
      if (isWritten) this.markDone('Firmware');
      return this.message.textContent ?? '';
    });
  };

  /** Applies the calibration in the text of the file `name`, without saving it in the board. */
  readonly setCalibration = (text: string, name: string): void => {
    this.runAction(async () => {
      const calibration = parseCalibration(text, name);
      const calibrator = await this.requireCalibrator();
      await calibrator.run((calibrator) => calibrator.replace(calibration));
      return `The robot has the calibration of ${name}, which is not saved yet.`;
    });
  };

  /** Runs an action with the robot's calibrator; shows the returned message, or the error. */
  readonly run = (action: (calibrator: Calibrator) => Promise<string>): void => this.runAction(async () => (await this.requireCalibrator()).run(action));

  /** Runs an action with the robot's calibrator, marks the step `done`, if any, as done, and shows a message. */
  readonly perform = (action: (calibrator: Calibrator) => Promise<void>, message: string, done?: string): void =>
    this.run(async (calibrator) => {
      await action(calibrator);
      if (done) this.markDone(done);
      return message;
    });

  /** Makes the robot stand, with all servos at neutral. */
  readonly stand = (): void =>
    this.run(async (calibrator) => {
      await calibrator.stand();
      this.lastTurn = null;
      return 'The robot stands.';
    });

  /** Returns the calibrator for the connected robot; starts the calibrator if needed. */
  private async requireCalibrator(): Promise<BoardCalibrator> {
    if (this.isLost) throw new Error(LOST_MESSAGE);
    if (!this.session.program.isFirmwareAnswering) throw new Error(NO_ROBOT_MESSAGE);
    if (this.calibrator) return this.calibrator;
    const { actionCount } = this;
    const calibrator = await BoardCalibrator.begin(this.session);
    // The action was dropped meanwhile, for example because the user has left, and must move no servo.
    if (actionCount !== this.actionCount) throw new Error(LOST_MESSAGE);
    this.calibrator = calibrator;
    return calibrator;
  }

  /** Runs an action unless another action is running; `isAutomatic` is true if the dialog itself starts the action. */
  private runAction(action: () => Promise<string>, isAutomatic = false): void {
    if (this.isLeaving) return;
    if (this.isBusy) {
      if (this.isAutomatic && !isAutomatic) this.queuedAction = action;
      return;
    }
    this.isAutomatic = isAutomatic;
    const actionNumber = ++this.actionCount;
    this.setBusy(true);
    this.setMessage('');
    this.runningAction = action()
      .catch(getMessage)
      .then((message) => {
        if (actionNumber !== this.actionCount) return;
        this.setBusy(false);
        this.setMessage(message);
        this.update();
        const { queuedAction } = this;
        this.queuedAction = null;
        if (queuedAction) this.runAction(queuedAction);
      });
  }

  private setBusy(isBusy: boolean): void {
    this.isBusy = isBusy;
    this.dialog.setAttribute('aria-busy', String(isBusy));
  }

  private readonly setMessage = (text: string): void => setText(this.message, text);

  readonly goTo = (name: string): void => {
    const step = STEPS.find((candidate) => candidate.name === name);
    if (step) this.enterStep(step);
  };

  private moveBy(stepCount: number): void {
    this.enterStep(STEPS[STEPS.indexOf(this.step) + stepCount] ?? this.step);
  }

  private enterStep(step: Step): void {
    if (step !== this.step) {
      if (step.isPerServo) this.servo = 0;
      this.lastTurn = null;
    }
    this.step = step;
    if (!this.isBusy) this.setMessage('');
    this.redraw();
    this.title.focus({ preventScroll: true });
    if (!step.needsRobot || !this.session.program.isFirmwareAnswering || this.isLost) return;
    // Servos that the previous step turned return to neutral, and the step shows the robot's current settings.
    const { calibrator } = this;
    if (!calibrator) this.runAction(async () => this.requireCalibrator().then(() => ''), true);
    else if (calibrator.mayBeOutdated || this.session.board.gait !== STAND) this.runAction(async () => calibrator.run((calibrator) => calibrator.stand()).then(() => ''), true);
  }

  readonly redraw = (): void => {
    const { step, session } = this;
    if (!session.board.link) return;
    const index = STEPS.indexOf(step);
    this.stepList.querySelectorAll('button').forEach((stepButton, n) => {
      setAttribute(stepButton, 'aria-current', n === index ? 'step' : null);
      if (n === index) this.stepList.scrollLeft = stepButton.offsetLeft - this.stepList.offsetLeft - (this.stepList.clientWidth - stepButton.offsetWidth) / 2;
      stepButton.classList.toggle('done', this.isDone(STEPS[n].name));
    });
    this.title.textContent = `${index + 1} of ${STEPS.length}: ${step.title}`;
    element<HTMLButtonElement>('setup-back').disabled = index === 0;
    element<HTMLButtonElement>('setup-next').disabled = index === STEPS.length - 1;
    const isLost = this.isLost && step !== boardStep;
    const isUsable = !isLost && (!step.needsRobot || session.program.isFirmwareAnswering);
    this.servoButtons.hidden = !isUsable || !step.isPerServo;
    this.servoButtons.querySelectorAll('button').forEach((servoButton, servo) => servoButton.setAttribute('aria-pressed', String(servo === this.servo)));
    const scene = session.robot.last?.scene ?? null;
    const drawing = isUsable && step.highlight && scene ? makeDrawing(session.robot.description, scene, step.highlight(this)) : null;
    this.drawingBox.replaceChildren(...(drawing ? [drawing] : []));
    this.drawingBox.hidden = !drawing;
    const tryOnSimulation = () => {
      this.isLost = false;
      this.enterStep(step);
    };
    const elements = isUsable
      ? step.makeElements(this)
      : [
          paragraph(isLost ? LOST_MESSAGE : NO_ROBOT_MESSAGE),
          row(
            button(isLost ? 'Connect it again…' : 'To the board', isLost ? this.toggleConnection : () => this.goTo(boardStep.name), true),
            ...(isLost ? [button('Try this step on the simulated UNO', tryOnSimulation)] : []),
          ),
        ];
    // The focus stays on a button with the same text, or else moves to the main button or the title.
    const focusedText = this.content.contains(document.activeElement) ? document.activeElement?.textContent : null;
    this.content.replaceChildren(...elements);
    if (focusedText === null) return;
    const buttons = [...this.content.querySelectorAll('button')];
    (buttons.find(({ textContent }) => textContent === focusedText) ?? this.content.querySelector<HTMLElement>('button.main') ?? this.title).focus();
  };
}
