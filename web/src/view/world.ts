// The controls of the simulated world: leg drive, feet, floor, mass, servos, supply voltage, and the contacts at the
// robot's inputs.
import { canLag, type Floor, type LegDrive, type ServoModel } from '../robot';
import type { Session } from '../session';
import { element, make } from './elements';

/** Number of decimals of each slider's value; the unit is in the slider's label. */
const DECIMALS = { force: 1, play: 1, leaf: 1, twist: 1, friction: 2, ratio: 2, mass: 0 };
type SliderName = keyof typeof DECIMALS;
const SLIDER_NAMES = Object.keys(DECIMALS) as SliderName[];
const getSlider = (name: SliderName) => element<HTMLInputElement>(name);

/** The label of each of the robot's inputs: the event that closes its contact. */
const CONTACT_LABELS: Record<string, string> = { button: 'button pressed', nose: 'wall at the nose' };

export class WorldView {
  private readonly driveList = element<HTMLSelectElement>('drive');
  private readonly servoList = element<HTMLSelectElement>('servos');
  private readonly voltsInput = element<HTMLInputElement>('servo-volts');
  private readonly supplyInput = element<HTMLInputElement>('supply');

  constructor(private readonly session: Session) {
    this.driveList.addEventListener('change', () => this.applySettings());
    for (const name of SLIDER_NAMES) {
      const input = getSlider(name);
      input.addEventListener('input', () => this.showText(input, input.valueAsNumber.toFixed(DECIMALS[name])));
      input.addEventListener('change', () => this.applySettings());
    }
    element('floor-reset').addEventListener('click', () => {
      this.session.setFloor(null);
      this.showRobot();
    });
    const { supplyInput, voltsInput } = this;
    for (const input of [supplyInput, voltsInput]) input.addEventListener('input', () => this.showVolts(input));
    supplyInput.addEventListener('change', () => this.session.setSupply(supplyInput.valueAsNumber));
    this.servoList.addEventListener('change', () => this.chooseServos(this.servoList.value));
    voltsInput.addEventListener('change', () => this.chooseServos(`${this.servoList.value} at ${voltsInput.value}`));
    session.followRobot(() => this.showRobot());
  }

  /** Shows the values of the session's robot. */
  private showRobot(): void {
    const { floor, description } = this.session;
    this.driveList.value = floor.kind;
    for (const name of SLIDER_NAMES) {
      const input = getSlider(name);
      // The slider's range grows to include the value.
      if (floor[name] > Number(input.max)) input.max = String(floor[name]);
      if (floor[name] < Number(input.min)) input.min = String(floor[name]);
      input.value = String(floor[name]);
      this.showText(input, floor[name].toFixed(DECIMALS[name]));
    }
    this.enableSliders(floor);
    this.servoList.replaceChildren(...description.models.map((model) => new Option(formatServoModel(model), model.name)));
    this.showServos();
    this.supplyInput.value = String(this.session.volts);
    this.showVolts(this.supplyInput);
    const [slowVolts, stopVolts, restVolts] = description.supply;
    this.showInputs();
    element('supply-note').textContent =
      `Below ${slowVolts} V, the pace is at most ${description.slow_pace} % and settings cannot be saved; below ${stopVolts} V, the robot stops; below ${restVolts} V, the pulses end.`;
  }

  private chooseServos(servos: string): void {
    this.session.setServos(servos);
    this.showServos();
    this.enableSliders(this.session.floor);
  }

  /** Shows the servo model and its supply voltage: the model's own unless the user has set another. */
  private showServos(): void {
    const { description, servos } = this.session;
    const [name = '', supply] = servos.split(' at ');
    this.servoList.value = name;
    const ratings = description.models.find((model) => model.name === name)?.ratings;
    this.voltsInput.disabled = !ratings;
    if (!ratings) return;
    const [, , , supplyVolts] = ratings;
    this.voltsInput.max = String(Math.max(6, supplyVolts));
    this.voltsInput.value = supply ?? String(supplyVolts);
    this.showVolts(this.voltsInput);
  }

  /** Shows a checkbox for each of the robot's inputs; the simulated contact is closed while the box is ticked. */
  private showInputs(): void {
    const { description, closedInputs } = this.session;
    const boxes = description.inputs.map(([name]) => {
      const box = make('input', { type: 'checkbox', checked: closedInputs.has(name) });
      box.addEventListener('change', () => this.session.setContact(name, box.checked));
      return make('label', {}, box, ` ${CONTACT_LABELS[name] ?? name}`);
    });
    element('inputs').replaceChildren(...boxes);
    element('inputs').hidden = boxes.length === 0;
  }

  /** Enables only the sliders that have an effect. */
  private enableSliders(floor: Floor): void {
    const hasSprings = floor.kind !== 'rigid';
    const isElastic = hasSprings || this.session.servos !== 'ideal';
    getSlider('force').disabled = !hasSprings;
    // If neither springs nor servos yield, friction has no effect; if no foot is too long either, mass has no effect.
    getSlider('friction').disabled = !isElastic;
    getSlider('mass').disabled = !isElastic && floor.twist === 0;
    getSlider('leaf').disabled = floor.twist === 0;
    element('rigid-note').hidden = isElastic || canLag(floor) || floor.twist !== 0;
  }

  private readonly showVolts = (input: HTMLInputElement): void => this.showText(input, input.valueAsNumber.toFixed(2));

  private showText(input: HTMLInputElement, text: string): void {
    element(`${input.id}-out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
  }

  /** Applies the leg drive and the sliders' values to the session. */
  private applySettings(): void {
    // A value whose displayed text is unchanged keeps its exact number.
    const floor: Floor = { ...this.session.floor, kind: this.driveList.value as LegDrive };
    for (const name of SLIDER_NAMES) {
      const value = getSlider(name).valueAsNumber;
      if (floor[name].toFixed(DECIMALS[name]) !== value.toFixed(DECIMALS[name])) floor[name] = value;
    }
    this.enableSliders(floor);
    this.session.setFloor(floor);
  }
}

/** Formats a servo model's label in the list. */
function formatServoModel({ name, ratings }: ServoModel): string {
  if (!ratings) return 'ideal: follows its pulse at once';
  const [torqueKgCm, seconds, volts] = ratings;
  return `${name === 'own' ? 'as in robot.toml' : name}: ${torqueKgCm} kg cm, ${seconds} s for 60° at ${volts} V`;
}
