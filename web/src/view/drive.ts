// The buttons of all gaits and routines. A gait's button also shows the predicted displacement per cycle, and the share
// of the servos' torque-speed line that the gait uses.
import { effect } from '@preact/signals-core';

import type { Predictor } from '../predictor';
import type { Description, Displacement } from '../robot';
import type { Session } from '../session';
import { WORDS } from '../words';
import { element, showMessage } from './canvas';
import { make } from './make';

/** Number of characters that fit on a button of the usual width. */
const BUTTON_CHARACTERS = 13;
/** Share of the servos' torque-speed line at and above which the page warns of little reserve. */
const HIGH_LOAD_SHARE = 0.9;
/** The longest text of a prediction; a button reserves room for it. */
const LONGEST_PREDICTION = '-999.9 mm, -99.9°';

/** Formats a displacement as a short text: mm forward, and degrees for a turn; '' for null. */
export function formatDisplacement(displacement: Displacement | null): string {
  if (!displacement) return '';
  const parts = [
    displacement.forward === null ? 'may drift' : Math.abs(displacement.forward) >= 0.5 ? `${displacement.forward.toFixed(1)} mm` : '',
    displacement.turn !== null && Math.abs(displacement.turn) >= 0.05 ? `${displacement.turn.toFixed(1)}°` : '',
  ];
  return parts.filter(Boolean).join(', ');
}

export class Drive {
  private readonly buttonList = element('gaits');
  /** The buttons with their parts; `note` shows the prediction, and `loadLabel` the share of the torque-speed line. */
  private buttons: { command: string; button: HTMLButtonElement; note: HTMLElement; loadLabel: HTMLElement; moves: boolean }[] = [];
  private readonly message = element('drive-said');
  /** The commands of the buttons in index.html, which every robot has. */
  readonly commands: string[] = [...document.querySelectorAll<HTMLElement>('[data-command]')].map(({ dataset }) => dataset.command ?? '');

  constructor(
    private readonly session: Session,
    private readonly predictor: Predictor,
  ) {
    document.addEventListener('click', (event) => {
      const button = event.target instanceof Element ? event.target.closest<HTMLElement>('[data-command]') : null;
      if (button?.dataset.command) void session.drive(button.dataset.command);
    });
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') void session.drive(WORDS.stop);
    });
    session.state.refusal.subscribe((refusal) => showMessage(this.message, refusal));
    session.followRobot((description) => this.showRobot(description));
    session.state.gait.subscribe((gait) => this.showActivity(gait));
    effect(() => this.showPredictions());
  }

  /** Shows the buttons of another robot. */
  private showRobot({ gaits, routines }: Description): void {
    this.buttonList.replaceChildren();
    this.buttons = [...gaits, ...routines.map((command) => ({ command, moves: false }))].map(({ command, moves }) => {
      const note = make('span', {});
      const noteBox = make('small', {}, note);
      const loadLabel = make('span', { className: 'line', title: 'share of their torque-speed line that its servos use at this pace' });
      if (moves) noteBox.dataset.room = LONGEST_PREDICTION;
      // A button with a long name is twice as wide.
      const button = make('button', { type: 'button', ariaPressed: 'false', className: command.length > BUTTON_CHARACTERS ? 'long' : '' }, command, noteBox, ...(moves ? [loadLabel] : []));
      button.dataset.command = command;
      this.buttonList.append(button);
      return { command, button, note, loadLabel, moves };
    });
    this.session.state.refusal.value = '';
    // A board that stays connected continues its gait.
    this.showActivity(this.session.gait);
  }

  /**
   * Shows each gait's predicted displacement and its share of the torque-speed line at the robot's pace, and, once all
   * are predicted, the gait with the largest share.
   */
  private showPredictions(): void {
    const predictions = this.predictor.predictions.value;
    const pace = this.session.state.pace.value;
    const areAllPredicted = this.buttons.every(({ command, moves }) => !moves || predictions.has(command));
    let [hardestGait, largestShare] = ['', 0];
    for (const { command, note, loadLabel } of this.buttons) {
      const prediction = predictions.get(command) ?? null;
      note.textContent = formatDisplacement(prediction);
      const lines = prediction?.lines;
      const share = lines?.[Math.ceil((pace * lines.length) / 100) - 1];
      const isHighLoad = share !== undefined && share >= HIGH_LOAD_SHARE;
      loadLabel.classList.toggle('tight', isHighLoad);
      loadLabel.textContent = share === undefined ? '' : `${isHighLoad ? '⚠ ' : ''}line ${share.toFixed(2)}`;
      if (areAllPredicted && share !== undefined && share > largestShare) [hardestGait, largestShare] = [command, share];
    }
    const note = element('line-note');
    note.classList.toggle('warning', largestShare >= HIGH_LOAD_SHARE);
    const advice = largestShare >= 1 ? ': they fall behind their pulses; a slower pace asks less' : largestShare >= HIGH_LOAD_SHARE ? ': little is left' : '';
    note.textContent = hardestGait === '' ? '' : `${hardestGait} asks most of its servos, ${largestShare.toFixed(2)} of their torque-speed line at ${pace} % of its pace${advice}.`;
  }

  /** Marks the button of the robot's current gait or routine. */
  private showActivity(command: string): void {
    for (const { button, command: buttonCommand } of this.buttons) {
      button.setAttribute('aria-pressed', String(buttonCommand === command));
    }
  }
}
