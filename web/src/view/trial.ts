// The view of an edited gait's trial in a simulation: the results, the nearest valid values if the gait is refused,
// and the buttons that use the gait.
import { applyGait, driveGait } from '../gaits/apply-gait';
import { type EditedGait, type GaitParameter, isRefused, type RobotOnFloor, type RefusedTrial, type Trial } from '../robot';
import { createRobotQueue } from '../robot-requests';
import type { Session } from '../session';
import { button, element, setText } from './elements';
import type { BoardWriter } from './writer';

/** The part of a gait editor that the trial view uses. */
export interface GaitEditorAccess {
  /** The prefix of the editor's element ids. */
  prefix: 'gait' | 'gesture';
  /** Returns the edited gait; null if there is none. */
  editedGait(): EditedGait | null;
  /** Sets a parameter of the gait to one of the valid values that a refusal suggests. */
  change(key: GaitParameter, value: number): void;
}

/** Formats a number with a unit, never as -0.0; null is the displacement of a robot that may drift. */
const formatNumber = (value: number | null, unit: string) => (value === null ? 'may drift' : `${(Number(value.toFixed(1)) + 0).toFixed(1)}${unit}`);

/** Formats the results of a trial; `unit` is the unit of the speed: mm/s for walking, otherwise °/s for turning. */
export function formatResults({ forward, turn, period, margin_name, min_margin, margin_limit, fastest_servo, max_servo_speed }: Trial, unit = 'mm/s') {
  const [displacement, speedUnit] = unit === 'mm/s' ? [forward, ' mm/s'] : [turn, ' °/s'];
  return {
    distance: formatNumber(forward, ' mm'),
    speed: displacement === null ? '–' : formatNumber(displacement / period, speedUnit),
    turn: formatNumber(turn, '°'),
    margin: `${min_margin.toFixed(3)} of ${margin_limit} (${margin_name.replaceAll('_', ' ')})`,
    fastest: `${fastest_servo}, ${max_servo_speed.toFixed(0)} °/s`,
    cycle: `${period} s`,
  };
}

/** The labels of the buttons that set a suggested value. */
const ALTERNATIVE_LABELS: Record<GaitParameter, (value: number) => string> = {
  amplitude: (value) => `Use amplitude ${value}°`,
  size: (value) => `Use a size of ${(100 * value).toFixed(0)} %`,
  period: (value) => `Use a cycle of ${value} s`,
};

export class TrialView {
  private readonly trialQueue = createRobotQueue<RobotOnFloor & { gait: EditedGait }, Trial | RefusedTrial | null>((robot, request) => robot.tryGait(request), (trial) => this.showResult(trial));
  /** The result of the last trial; null if the gait was refused. */
  private trial: Trial | null = null;

  constructor(
    private readonly session: Session,
    private readonly writer: BoardWriter,
    private readonly editor: GaitEditorAccess,
  ) {
    this.element('try').addEventListener('click', () => void this.driveEditedGait());
    this.element('write').addEventListener('click', () => void this.writeToBoard());
    this.element('copy').addEventListener('click', () => void this.copyTable());
  }

  /** Requests a trial of the edited gait; without a gait, removes the results of the previous one. */
  requestTrial(): void {
    const { toml, floor, servos } = this.session.robot;
    const gait = this.editor.editedGait();
    if (!gait) return this.showResult(null);
    if (toml === '') return;
    this.trialQueue.submit({ toml, floor, servos, gait });
  }

  /** Shows a message beside the editor's buttons. */
  readonly setMessage = (text: string): void => setText(this.element('message'), text);

  private element<E extends HTMLElement = HTMLElement>(name: string): E {
    return element<E>(`${this.editor.prefix}-${name}`);
  }

  private showResult(result: Trial | RefusedTrial | null): void {
    // The result of a gait that was removed meanwhile is not shown.
    const trial = this.editor.editedGait() && result;
    const refusal = trial && isRefused(trial) ? trial : null;
    const validTrial = trial && !isRefused(trial) ? trial : null;
    this.trial = validTrial;
    for (const name of ['try', 'write', 'copy']) this.element<HTMLButtonElement>(name).disabled = !validTrial;
    const show = (name: string, text: string) => setText(this.element(name), text);
    const results = validTrial && formatResults(validTrial);
    for (const name of ['distance', 'speed', 'turn', 'margin', 'fastest'] as const) show(name, results?.[name] ?? '–');
    show('table', validTrial?.table ?? '');
    this.element('refused').hidden = refusal === null;
    show('refusal', refusal?.reason ?? '');
    this.element('alternatives').replaceChildren(
      ...(refusal?.alternatives ?? []).map(({ parameter, value }) => button(ALTERNATIVE_LABELS[parameter](value), () => this.editor.change(parameter, value))),
    );
    this.setMessage('');
  }

  private async driveEditedGait(): Promise<void> {
    const gait = this.editor.editedGait();
    if (!gait) return;
    this.setMessage('The robot restarts with this gait…');
    const refusal = await driveGait(this.session, gait);
    this.setMessage(refusal?.reason ?? `The robot starts ${gait.name.replaceAll('-', ' ')}, which now has a button in Drive and is part of the downloaded robot.toml.`);
  }

  private async writeToBoard(): Promise<void> {
    const gait = this.editor.editedGait();
    if (!gait) return;
    const { session } = this;
    const refusal = session.board.isReal ? await applyGait(session, gait) : null;
    if (refusal) return this.setMessage(refusal.reason);
    if (!(await this.writer.writeRobot(this.editor.prefix))) return;
    this.setMessage(`${this.element('message').textContent}. The board has restarted; ${gait.name.replaceAll('-', ' ')} has a button in Drive.`);
  }

  private async copyTable(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.trial?.table ?? '');
      this.setMessage('The table for robot.toml is copied.');
    } catch {
      this.setMessage('The browser does not allow the page to copy; select the table and copy it by hand.');
    }
  }
}
