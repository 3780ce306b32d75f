// The servo calibration panel: `cal` reads the settings, the inputs change them, and `save` stores them.
import { loadBoardModule } from '../board-module';
import type { ServoSettings } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { WORDS } from '../words';
import { element, make } from './elements';
import { isShown } from './rooms';

/** The inputs of a servo. */
interface ServoInputs {
  trim: HTMLInputElement;
  scale: HTMLInputElement;
  min: HTMLInputElement;
  max: HTMLInputElement;
  dir: HTMLSelectElement;
}

export class CalibrationView {
  private readonly container = element('calibration');
  private readonly message = element('cal-message');
  private servoInputs: ServoInputs[] = [];
  /** True after a command without an answer: the shown settings may differ from the robot's settings. */
  private mayBeOutdated = false;

  constructor(private readonly session: Session) {
    element('cal-read').addEventListener('click', () => void this.read());
    element('cal-save').addEventListener('click', () => void this.send(WORDS.save));
    for (const word of [WORDS.load, WORDS.factory]) {
      element(`cal-${word}`).addEventListener('click', () => void this.send(word).then(() => this.read()));
    }
    const panel = element<HTMLDetailsElement>('calibrate');
    panel.addEventListener('toggle', () => isShown(panel) && void this.read());
    // The robot answers again.
    session.state.status.subscribe(() => this.mayBeOutdated && void this.read());
  }

  /** Reads the robot's settings and shows them. */
  async read(): Promise<void> {
    const answer = await this.session.ask(WORDS.cal, true);
    const board = await loadBoardModule().catch((error: unknown) => {
      this.message.textContent = getMessage(error);
      return null;
    });
    const settings = answer && board?.readCalibration(answer.notes);
    if (!settings) return;
    this.mayBeOutdated = false;
    if (this.servoInputs.length === 0) this.buildInputs();
    settings.servos.forEach((servo, index) => this.showServo(index, servo));
  }

  private showServo(index: number, { trim, limit, dir, scale }: ServoSettings): void {
    const inputs = this.servoInputs[index];
    inputs.trim.value = String(trim);
    inputs.trim.dispatchEvent(new Event('value-set'));
    inputs.scale.value = String(scale);
    [inputs.min.value, inputs.max.value] = limit.map(String);
    inputs.dir.value = dir;
  }

  private async send(line: string): Promise<void> {
    const answer = await this.session.ask(line);
    this.message.textContent = answer?.text ?? '';
    this.mayBeOutdated ||= answer === null;
    if (answer && !answer.ok) await this.read();
  }

  private buildInputs(): void {
    this.servoInputs = [1, 2, 3, 4].map((servoNumber) => {
      const group = make('fieldset', {}, make('legend', {}, `A${servoNumber}`));
      const trim = this.makeTrim(group, servoNumber);
      const numbers = make('div', { className: 'numbers' });
      group.append(numbers);
      this.container.append(group);
      const addNumber = (label: string, step: string) => {
        const input = make('input', { type: 'number', step });
        numbers.append(make('label', {}, label, input));
        return input;
      };
      const min = addNumber('from, deg', '1');
      const max = addNumber('to, deg', '1');
      const scale = addNumber('µs per deg', '0.01');
      const dir = make('select', {}, new Option('left (+)', '+'), new Option('right (−)', '-'));
      numbers.append(make('label', {}, 'longer pulse turns', dir));
      for (const input of [min, max]) {
        input.addEventListener('change', () => void this.send(`${WORDS.limit} ${servoNumber} ${min.value} ${max.value}`));
      }
      scale.addEventListener('change', () => void this.send(`${WORDS.scale} ${servoNumber} ${scale.value}`));
      dir.addEventListener('change', () => void this.send(`${WORDS.dir} ${servoNumber} ${dir.value}`));
      return { trim, scale, min, max, dir };
    });
  }

  private makeTrim(group: HTMLElement, servoNumber: number): HTMLInputElement {
    const trim = make('input', { type: 'range', min: '-20', max: '20', step: '0.25' });
    const output = make('output', {});
    group.append(make('label', { className: 'slider' }, 'trim ', trim, output));
    const showTrim = () => (output.textContent = `${Number(trim.value).toFixed(2)}°`);
    trim.addEventListener('input', showTrim);
    trim.addEventListener('value-set', showTrim);
    trim.addEventListener('change', () => void this.send(`${WORDS.trim} ${servoNumber} ${trim.value}`));
    return trim;
  }
}
