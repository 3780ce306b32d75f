// The sliders of leg drive, feet, floor, mass, servos and supply.
import { type Floor, type Kind, lags, type ServoModel } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';

const round = (value: number, digits: number) => Number(value.toFixed(digits)).toString();

/** The number format of each slider; the unit is in its label. */
const SHOWN = {
  force: (value: number) => value.toFixed(1),
  play: (value: number) => value.toFixed(1),
  leaf: (value: number) => value.toFixed(1),
  twist: (value: number) => value.toFixed(1),
  friction: (value: number) => value.toFixed(2),
  ratio: (value: number) => value.toFixed(2),
  mass: (value: number) => round(value, 0),
};
type Plain = keyof typeof SHOWN;
const PLAIN = Object.keys(SHOWN) as Plain[];

export class World {
  private readonly drive = element<HTMLSelectElement>('drive');
  private readonly servos = element<HTMLSelectElement>('servos');
  private readonly supply = element<HTMLInputElement>('supply');

  /** Calls `onFloor` when the predictions have changed. */
  constructor(
    private readonly session: () => Session,
    private readonly onFloor: () => void,
  ) {
    this.drive.addEventListener('change', () => this.use());
    for (const name of PLAIN) {
      const input = this.input(name);
      input.addEventListener('input', () => this.show(input, SHOWN[name](input.valueAsNumber)));
      input.addEventListener('change', () => this.use());
    }
    element('floor-reset').addEventListener('click', () => {
      this.session().setFloor(null);
      this.take();
      this.onFloor();
    });
    const { supply } = this;
    supply.addEventListener('input', () => this.show(supply, supply.valueAsNumber.toFixed(2)));
    supply.addEventListener('change', () => this.session().setSupply(supply.valueAsNumber));
    this.servos.addEventListener('change', () => {
      this.session().setServos(this.servos.value);
      this.onFloor();
    });
  }

  /** Shows the values of the session's robot. */
  take(): void {
    const { floor, description } = this.session();
    this.drive.value = floor.kind;
    for (const name of PLAIN) {
      const input = this.input(name);
      // The slider widens for a value beyond its range.
      if (floor[name] > Number(input.max)) input.max = String(floor[name]);
      if (floor[name] < Number(input.min)) input.min = String(floor[name]);
      input.value = String(floor[name]);
      this.show(input, SHOWN[name](floor[name]));
    }
    this.enable(floor);
    if (this.servos.length === 0) {
      for (const model of description.models) this.servos.add(new Option(describe(model), model.name));
    }
    this.servos.value = this.session().servos;
    this.supply.value = String(this.session().volts);
    this.show(this.supply, this.supply.valueAsNumber.toFixed(2));
    const [slow, stop, rest] = description.supply;
    element('supply-note').textContent =
      `Below ${slow} V gaits go at half their pace, below ${stop} V the robot stops, below ${rest} V the pulses end.`;
  }

  private input(name: Plain): HTMLInputElement {
    return element<HTMLInputElement>(name);
  }

  /** Disables the sliders that have no effect. */
  private enable(floor: Floor): void {
    const springs = floor.kind !== 'rigid';
    this.input('force').disabled = !springs;
    // Friction cancels out without springs, and so does mass without a long foot.
    this.input('friction').disabled = !springs;
    this.input('mass').disabled = !springs && floor.twist === 0;
    this.input('leaf').disabled = floor.twist === 0;
    element('rigid-note').hidden = lags(floor) || floor.twist !== 0;
  }

  private show(input: HTMLInputElement, text: string): void {
    element(`${input.id}-out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
  }

  private use(): void {
    // A slider that was not moved keeps its exact value.
    const own = this.session().floor;
    const number = (name: Plain) => {
      const input = this.input(name);
      return SHOWN[name](own[name]) === SHOWN[name](input.valueAsNumber) ? own[name] : input.valueAsNumber;
    };
    const floor: Floor = {
      friction: number('friction'),
      ratio: number('ratio'),
      mass: number('mass'),
      kind: this.drive.value as Kind,
      force: number('force'),
      rate: own.rate,
      play: number('play'),
      leaf: number('leaf'),
      twist: number('twist'),
    };
    this.enable(floor);
    this.session().setFloor(floor);
    this.onFloor();
  }
}

function describe({ name, rate, dead_band }: ServoModel): string {
  return rate === null ? 'ideal: where the pulse says, at once' : `${name.toUpperCase().replace('SG', 'SG-')}: ${rate}°/s, dead band ${dead_band} µs`;
}
