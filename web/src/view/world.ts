// The controls of the simulated world: leg drive, feet, floor, mass, servos, supply voltage and the contacts at the
// robot's inputs.
import { type Floor, type Kind, lags, type ServoModel } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { make } from './make';

/** Formats a number with at most `digits` decimals. */
const formatRounded = (value: number, digits: number) => Number(value.toFixed(digits)).toString();

/** The number format of each slider; the unit is in the slider's label. */
const SLIDER_FORMATS = {
  force: (value: number) => value.toFixed(1),
  play: (value: number) => value.toFixed(1),
  leaf: (value: number) => value.toFixed(1),
  twist: (value: number) => value.toFixed(1),
  friction: (value: number) => value.toFixed(2),
  ratio: (value: number) => value.toFixed(2),
  mass: (value: number) => formatRounded(value, 0),
};
type SliderName = keyof typeof SLIDER_FORMATS;
const SLIDER_NAMES = Object.keys(SLIDER_FORMATS) as SliderName[];

/** The label of each of the robot's inputs: the event that closes its contact. */
const CONTACT_LABELS: Record<string, string> = { button: 'button pressed', nose: 'wall at the nose' };

export class World {
  private readonly driveList = element<HTMLSelectElement>('drive');
  private readonly servoList = element<HTMLSelectElement>('servos');
  private readonly voltsInput = element<HTMLInputElement>('servo-volts');
  private readonly supplyInput = element<HTMLInputElement>('supply');

  constructor(private readonly session: Session) {
    this.driveList.addEventListener('change', () => this.applyFloor());
    for (const name of SLIDER_NAMES) {
      const input = this.sliderOf(name);
      input.addEventListener('input', () => this.showText(input, SLIDER_FORMATS[name](input.valueAsNumber)));
      input.addEventListener('change', () => this.applyFloor());
    }
    element('floor-reset').addEventListener('click', () => {
      this.session.setFloor(null);
      this.showRobot();
    });
    const { supplyInput } = this;
    supplyInput.addEventListener('input', () => this.showText(supplyInput, supplyInput.valueAsNumber.toFixed(2)));
    supplyInput.addEventListener('change', () => this.session.setSupply(supplyInput.valueAsNumber));
    this.servoList.addEventListener('change', () => this.chooseServos(this.servoList.value));
    const { voltsInput } = this;
    voltsInput.addEventListener('input', () => this.showText(voltsInput, voltsInput.valueAsNumber.toFixed(2)));
    voltsInput.addEventListener('change', () => this.chooseServos(`${this.servoList.value} at ${voltsInput.value}`));
    session.followRobot(() => this.showRobot());
  }

  /** Shows the values of the session's robot. */
  private showRobot(): void {
    const { floor, description } = this.session;
    this.driveList.value = floor.kind;
    for (const name of SLIDER_NAMES) {
      const input = this.sliderOf(name);
      // The slider widens for a value beyond its range.
      if (floor[name] > Number(input.max)) input.max = String(floor[name]);
      if (floor[name] < Number(input.min)) input.min = String(floor[name]);
      input.value = String(floor[name]);
      this.showText(input, SLIDER_FORMATS[name](floor[name]));
    }
    this.enableSliders(floor);
    this.servoList.replaceChildren(...description.models.map((model) => new Option(describeServo(model), model.name)));
    this.showServos();
    this.supplyInput.value = String(this.session.volts);
    this.showText(this.supplyInput, this.supplyInput.valueAsNumber.toFixed(2));
    const [slowVolts, stopVolts, restVolts] = description.supply;
    this.showInputs();
    element('supply-note').textContent =
      `Below ${slowVolts} V gaits go at ${description.slow_pace} % of their pace at most and nothing is saved, below ${stopVolts} V the robot stops, below ${restVolts} V the pulses end.`;
  }

  private chooseServos(servos: string): void {
    this.session.setServos(servos);
    this.showServos();
    this.enableSliders(this.session.floor);
  }

  /** Shows the servo model and its supply voltage, which is the model's own unless the user has set another. */
  private showServos(): void {
    const { description, servos } = this.session;
    const [name = '', supply] = servos.split(' at ');
    this.servoList.value = name;
    const figures = description.models.find((model) => model.name === name)?.figures;
    this.voltsInput.disabled = !figures;
    if (!figures) return;
    this.voltsInput.max = String(Math.max(6, figures[3]));
    this.voltsInput.value = supply ?? String(figures[3]);
    this.showText(this.voltsInput, this.voltsInput.valueAsNumber.toFixed(2));
  }

  /** Shows a checkbox for each input of the robot: its simulated contact is closed while the box is ticked. */
  private showInputs(): void {
    const { description, closedInputs: closed } = this.session;
    const boxes = description.inputs.map(([name]) => {
      const box = make('input', { type: 'checkbox', checked: closed.has(name) });
      box.addEventListener('change', () => this.session.setContact(name, box.checked));
      return make('label', {}, box, ` ${CONTACT_LABELS[name] ?? name}`);
    });
    element('inputs').replaceChildren(...boxes);
    element('inputs').hidden = boxes.length === 0;
  }

  private sliderOf(name: SliderName): HTMLInputElement {
    return element<HTMLInputElement>(name);
  }

  /** Enables the sliders that have an effect, and disables the others. */
  private enableSliders(floor: Floor): void {
    const hasSprings = floor.kind !== 'rigid';
    const isElastic = hasSprings || this.session.servos !== 'ideal';
    this.sliderOf('force').disabled = !hasSprings;
    // If neither springs nor servos yield, friction has no effect, and neither has mass if no foot is too long.
    this.sliderOf('friction').disabled = !isElastic;
    this.sliderOf('mass').disabled = !isElastic && floor.twist === 0;
    this.sliderOf('leaf').disabled = floor.twist === 0;
    element('rigid-note').hidden = isElastic || lags(floor) || floor.twist !== 0;
  }

  private showText(input: HTMLInputElement, text: string): void {
    element(`${input.id}-out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
  }

  /** Sets the sliders' values in the session. */
  private applyFloor(): void {
    // A slider that was not moved keeps its exact value.
    const currentFloor = this.session.floor;
    const sliderValue = (name: SliderName) => {
      const input = this.sliderOf(name);
      return SLIDER_FORMATS[name](currentFloor[name]) === SLIDER_FORMATS[name](input.valueAsNumber) ? currentFloor[name] : input.valueAsNumber;
    };
    const floor: Floor = {
      friction: sliderValue('friction'),
      ratio: sliderValue('ratio'),
      mass: sliderValue('mass'),
      kind: this.driveList.value as Kind,
      force: sliderValue('force'),
      rate: currentFloor.rate,
      play: sliderValue('play'),
      leaf: sliderValue('leaf'),
      twist: sliderValue('twist'),
    };
    this.enableSliders(floor);
    this.session.setFloor(floor);
  }
}

/** Returns the label of a servo model in the list. */
function describeServo({ name, figures }: ServoModel): string {
  if (!figures) return 'ideal: where the pulse says, at once';
  const [torque, seconds, volts] = figures;
  return `${name === 'own' ? 'as in robot.toml' : name}: ${torque} kg cm, ${seconds} s for 60° at ${volts} V`;
}
