// The sliders of leg drive, feet, floor, mass, servos and supply, and the inputs.
import { type Floor, type Kind, lags, type ServoModel } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { make } from './make';

const formatRounded = (value: number, digits: number) => Number(value.toFixed(digits)).toString();

/** The number format of each slider; the unit is in its label. */
const FORMATS = {
  force: (value: number) => value.toFixed(1),
  play: (value: number) => value.toFixed(1),
  leaf: (value: number) => value.toFixed(1),
  twist: (value: number) => value.toFixed(1),
  friction: (value: number) => value.toFixed(2),
  ratio: (value: number) => value.toFixed(2),
  mass: (value: number) => formatRounded(value, 0),
};
type SliderName = keyof typeof FORMATS;
const SLIDERS = Object.keys(FORMATS) as SliderName[];

/** The label of each input: the event that closes its contact. */
const CONTACTS: Record<string, string> = { button: 'button pressed', nose: 'wall at the nose' };

export class World {
  private readonly drive = element<HTMLSelectElement>('drive');
  private readonly servos = element<HTMLSelectElement>('servos');
  private readonly volts = element<HTMLInputElement>('servo-volts');
  private readonly supply = element<HTMLInputElement>('supply');

  /** Calls `onChange` when the predictions have changed. */
  constructor(
    private readonly session: () => Session,
    private readonly onChange: () => void,
  ) {
    this.drive.addEventListener('change', () => this.applyFloor());
    for (const name of SLIDERS) {
      const input = this.input(name);
      input.addEventListener('input', () => this.show(input, FORMATS[name](input.valueAsNumber)));
      input.addEventListener('change', () => this.applyFloor());
    }
    element('floor-reset').addEventListener('click', () => {
      this.session().setFloor(null);
      this.showRobot();
      this.onChange();
    });
    const { supply } = this;
    supply.addEventListener('input', () => this.show(supply, supply.valueAsNumber.toFixed(2)));
    supply.addEventListener('change', () => this.session().setSupply(supply.valueAsNumber));
    this.servos.addEventListener('change', () => this.setServos(this.servos.value));
    const { volts } = this;
    volts.addEventListener('input', () => this.show(volts, volts.valueAsNumber.toFixed(2)));
    volts.addEventListener('change', () => this.setServos(`${this.servos.value} at ${volts.value}`));
  }

  /** Shows the values of the session's robot. */
  showRobot(): void {
    const { floor, description } = this.session();
    this.drive.value = floor.kind;
    for (const name of SLIDERS) {
      const input = this.input(name);
      // The slider widens for a value beyond its range.
      if (floor[name] > Number(input.max)) input.max = String(floor[name]);
      if (floor[name] < Number(input.min)) input.min = String(floor[name]);
      input.value = String(floor[name]);
      this.show(input, FORMATS[name](floor[name]));
    }
    this.enableSliders(floor);
    this.servos.replaceChildren(...description.models.map((model) => new Option(describe(model), model.name)));
    this.showServos();
    this.supply.value = String(this.session().volts);
    this.show(this.supply, this.supply.valueAsNumber.toFixed(2));
    const [slow, stop, rest] = description.supply;
    this.showInputs();
    element('supply-note').textContent =
      `Below ${slow} V gaits go at ${description.slow_pace} % of their pace at most and nothing is saved, below ${stop} V the robot stops, below ${rest} V the pulses end.`;
  }

  private setServos(servos: string): void {
    this.session().setServos(servos);
    this.showServos();
    this.enableSliders(this.session().floor);
    this.onChange();
  }

  /** Shows the servo model and its supply voltage: as set by the user, else the model's own. */
  private showServos(): void {
    const { description, servos } = this.session();
    const [name = '', supply] = servos.split(' at ');
    this.servos.value = name;
    const figures = description.models.find((model) => model.name === name)?.figures;
    this.volts.disabled = !figures;
    if (!figures) return;
    this.volts.max = String(Math.max(6, figures[3]));
    this.volts.value = supply ?? String(figures[3]);
    this.show(this.volts, this.volts.valueAsNumber.toFixed(2));
  }

  /** Shows a checkbox for each input of the robot: its simulated contact is closed while the box is ticked. */
  private showInputs(): void {
    const { description, closed } = this.session();
    const boxes = description.inputs.map(([name]) => {
      const box = make('input', { type: 'checkbox', checked: closed.has(name) });
      box.addEventListener('change', () => this.session().setContact(name, box.checked));
      return make('label', {}, box, ` ${CONTACTS[name] ?? name}`);
    });
    element('inputs').replaceChildren(...boxes);
    element('inputs').hidden = boxes.length === 0;
  }

  private input(name: SliderName): HTMLInputElement {
    return element<HTMLInputElement>(name);
  }

  /** Enables the sliders that have an effect, and disables the others. */
  private enableSliders(floor: Floor): void {
    const hasSprings = floor.kind !== 'rigid';
    const isElastic = hasSprings || this.session().servos !== 'ideal';
    this.input('force').disabled = !hasSprings;
    // If neither springs nor servos yield, friction has no effect, nor has mass if no foot is too long.
    this.input('friction').disabled = !isElastic;
    this.input('mass').disabled = !isElastic && floor.twist === 0;
    this.input('leaf').disabled = floor.twist === 0;
    element('rigid-note').hidden = isElastic || lags(floor) || floor.twist !== 0;
  }

  private show(input: HTMLInputElement, text: string): void {
    element(`${input.id}-out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
  }

  private applyFloor(): void {
    // A slider that was not moved keeps its exact value.
    const currentFloor = this.session().floor;
    const sliderValue = (name: SliderName) => {
      const input = this.input(name);
      return FORMATS[name](currentFloor[name]) === FORMATS[name](input.valueAsNumber) ? currentFloor[name] : input.valueAsNumber;
    };
    const floor: Floor = {
      friction: sliderValue('friction'),
      ratio: sliderValue('ratio'),
      mass: sliderValue('mass'),
      kind: this.drive.value as Kind,
      force: sliderValue('force'),
      rate: currentFloor.rate,
      play: sliderValue('play'),
      leaf: sliderValue('leaf'),
      twist: sliderValue('twist'),
    };
    this.enableSliders(floor);
    this.session().setFloor(floor);
    this.onChange();
  }
}

function describe({ name, figures }: ServoModel): string {
  if (!figures) return 'ideal: where the pulse says, at once';
  const [torque, seconds, volts] = figures;
  return `${name === 'own' ? 'as in robot.toml' : name}: ${torque} kg cm, ${seconds} s for 60° at ${volts} V`;
}
