// The buttons of all gaits and routines. A gait's button also shows the predicted displacement per cycle, and the load:
// the fraction of the servos' torque-speed line that the gait uses.
import { effect } from '@preact/signals-core';

import type { Predictor } from '../predictor';
import type { Description, Displacement } from '../robot';
import type { Session } from '../session';
import { WORDS } from '../words';
import { element, make, showMessage } from './elements';

/** Largest number of characters that fit on a button of normal width. */
const MAX_BUTTON_CHARACTERS = 13;
/** Load at which the page starts to warn of a small reserve. */
const HIGH_LOAD = 0.9;
/** The longest text of a prediction, for which a button reserves space. */
const LONGEST_PREDICTION = '-999.9 mm, -99.9°';

/** Formats a displacement as a short text: mm forward, and degrees of turn; '' for null. */
export function formatDisplacement(displacement: Displacement | null): string {
  if (!displacement) return '';
  const parts = [
    displacement.forward === null ? 'may drift' : Math.abs(displacement.forward) >= 0.5 ? `${displacement.forward.toFixed(1)} mm` : '',
    displacement.turn !== null && Math.abs(displacement.turn) >= 0.05 ? `${displacement.turn.toFixed(1)}°` : '',
  ];
  return parts.filter(Boolean).join(', ');
}

export class DriveView {
  /** The buttons with their labels; `moves` is true if the gait moves a servo. */
  private buttons: { command: string; button: HTMLButtonElement; predictionLabel: HTMLElement; loadLabel: HTMLElement; moves: boolean }[] = [];
  /** The commands of the buttons in index.html, which exist for every robot. */
  readonly commands: string[] = [...document.querySelectorAll<HTMLElement>('[data-command]')].map(({ dataset }) => dataset.command ?? '');

  constructor(
    private readonly session: Session,
    private readonly predictor: Predictor,
  ) {
    document.addEventListener('click', (event) => {
      const button = event.target instanceof Element ? event.target.closest<HTMLElement>('[data-command]') : null;
      if (button?.dataset.command) void session.board.drive(button.dataset.command);
    });
    document.addEventListener('keydown', ({ key }) => key === 'Escape' && void session.board.drive(WORDS.stop));
    session.state.refusal.subscribe((refusal) => showMessage(element('drive-message'), refusal));
    session.robot.follow((description) => this.showRobot(description));
    session.state.gait.subscribe((gait) => this.markCurrentCommand(gait));
    effect(() => this.showPredictions());
  }

  /** Replaces the buttons with those of a new robot. */
  private showRobot({ gaits, routines }: Description): void {
    element('gaits').replaceChildren();
    this.buttons = [...gaits, ...routines.map((command) => ({ command, moves: false }))].map(({ command, moves }) => {
      const predictionLabel = make('span', {});
      const predictionBox = make('small', {}, predictionLabel);
      const loadLabel = make('span', { className: 'load', title: 'fraction of the servos’ torque-speed line that the gait uses at this pace' });
      if (moves) predictionBox.dataset.longestText = LONGEST_PREDICTION;
      // A button with a long name is twice as wide.
      const button = make('button', { type: 'button', ariaPressed: 'false', className: command.length > MAX_BUTTON_CHARACTERS ? 'long' : '' }, command, predictionBox, ...(moves ? [loadLabel] : []));
      button.dataset.command = command;
      element('gaits').append(button);
      return { command, button, predictionLabel, loadLabel, moves };
    });
    this.session.state.refusal.value = '';
    // A connected board continues its gait.
    this.markCurrentCommand(this.session.board.gait);
  }

  /**
   * Shows each gait's predicted displacement and its load at the robot's pace. Once all gaits are predicted, also shows
   * the gait with the highest load.
   */
  private showPredictions(): void {
    const predictions = this.predictor.predictions.value;
    const pace = this.session.state.pace.value;
    const allPredicted = this.buttons.every(({ command, moves }) => !moves || predictions.has(command));
    let [highestLoadGait, highestLoad] = ['', 0];
    for (const { command, predictionLabel, loadLabel } of this.buttons) {
      const prediction = predictions.get(command) ?? null;
      predictionLabel.textContent = formatDisplacement(prediction);
      const loads = prediction?.utilisations;
      const load = loads?.[Math.ceil((pace * loads.length) / 100) - 1];
      const isHigh = load !== undefined && load >= HIGH_LOAD;
      loadLabel.classList.toggle('high-load', isHigh);
      loadLabel.textContent = load === undefined ? '' : `${isHigh ? '⚠ ' : ''}load ${load.toFixed(2)}`;
      if (allPredicted && load !== undefined && load > highestLoad) [highestLoadGait, highestLoad] = [command, load];
    }
    const note = element('load-note');
    note.classList.toggle('warning', highestLoad >= HIGH_LOAD);
    const advice = highestLoad >= 1 ? ': the servos lag behind their pulses; choose a slower pace' : highestLoad >= HIGH_LOAD ? ': the reserve is small' : '';
    note.textContent = highestLoadGait === '' ? '' : `${highestLoadGait} has the highest load: it uses ${highestLoad.toFixed(2)} of the servos’ torque-speed line at a pace of ${pace} %${advice}.`;
  }

  /** Marks the button of the robot's current gait or routine. */
  private markCurrentCommand(command: string): void {
    for (const { button, command: buttonCommand } of this.buttons) {
      button.setAttribute('aria-pressed', String(buttonCommand === command));
    }
  }
}
