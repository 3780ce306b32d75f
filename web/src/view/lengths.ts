// The number inputs of the robot's lengths. Each change makes a new robot or is refused.
import { type Edits, type Length, Robot } from '../robot';
import type { Session } from '../session';
import { downloadRobot } from './download';
import { element, make, showMessage } from './elements';
import { describeRefusal, makeEditsWithTwin, showOffers } from './tried-lengths';

export class LengthsView {
  private readonly list = element('lengths');
  private readonly symmetryBox = element<HTMLInputElement>('alike');
  private readonly refusalText = element('lengths-refusal');
  private inputs = new Map<string, HTMLInputElement>();

  /** `offerValidLengths` searches for valid alternatives to refused lengths and offers them. */
  constructor(
    private readonly session: Session,
    private readonly offerValidLengths: (edits: Edits) => void,
  ) {
    element('lengths-reset').addEventListener('click', () => void session.change(session.original));
    element('lengths-save').addEventListener('click', () => this.download());
    session.followRobot(({ lengths }) => this.showRobot(lengths));
  }

  private showRobot(lengths: Length[]): void {
    if (lengths.length !== this.inputs.size) this.buildInputs(lengths);
    for (const { key, value } of lengths) {
      const input = this.inputs.get(key);
      if (!input) continue;
      input.value = String(value);
      input.removeAttribute('aria-invalid');
    }
    this.setMessage('');
  }

  private buildInputs(lengths: Length[]): void {
    this.list.replaceChildren();
    this.inputs.clear();
    for (const { key, label, unit } of lengths) {
      const input = make('input', { type: 'number', step: '0.5', name: key });
      this.list.append(make('label', {}, `${label} (${key.replace('links.', '')}, ${unit})`, input));
      input.addEventListener('change', () => void this.changeLength(key));
      this.inputs.set(key, input);
    }
  }

  private async changeLength(key: string): Promise<void> {
    const session = this.session;
    const input = this.inputs.get(key);
    const value = input?.valueAsNumber;
    if (!input || value === undefined || !Number.isFinite(value)) return;
    const edits = makeEditsWithTwin(key, value, session.description.lengths, this.symmetryBox.checked);
    const { text, refusal } = Robot.tryLengths(session.toml, edits, false);
    if (!refusal) return void (await session.change(text));
    const { lengths } = session.description;
    const refusedLengths = lengths.filter((length) => edits.some(([editedKey]) => editedKey === length.key));
    // The inputs return to the robot's lengths.
    for (const length of refusedLengths) {
      const lengthInput = this.inputs.get(length.key);
      if (!lengthInput) continue;
      lengthInput.value = String(length.value);
      lengthInput.setAttribute('aria-invalid', 'true');
    }
    this.setMessage(describeRefusal(`${value} ${refusedLengths[0]?.unit}`, edits, refusal, lengths));
    this.offerValidLengths(edits);
  }

  private download(): void {
    const { toml, floor } = this.session;
    const refusal = downloadRobot(toml, floor);
    if (refusal) this.setMessage(`This robot.toml does not have the settings of Legs, feet and floor: ${refusal.refused}`);
  }

  private setMessage(message: string): void {
    showMessage(this.refusalText, message);
    showOffers(null, this.session);
  }
}
