// The sliders of what is around the robot: springs, floor, weight, servos, supply.
import type { Floor, ServoModel } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';

/** Stiffnesses that the slider has, N mm/deg; its last position is a rigid leg. */
const STIFFNESS = [0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 7, 10, 15, 20, 30, 50];

const round = (value: number, digits: number) => Number(value.toFixed(digits)).toString();

/** How a slider's number is written; its unit is in its label. */
const SHOWN = {
  preload: (value: number) => round(value, 1),
  friction: (value: number) => value.toFixed(2),
  ratio: (value: number) => value.toFixed(2),
  mass: (value: number) => round(value, 0),
};
type Plain = keyof typeof SHOWN;
const PLAIN = Object.keys(SHOWN) as Plain[];

export class World {
  private readonly springs = element<HTMLInputElement>('springs');
  private readonly servos = element<HTMLSelectElement>('servos');
  private readonly supply = element<HTMLInputElement>('supply');
  private stiffness: number[] = STIFFNESS;

  /** `onFloor` is called when the ways of gaits have changed. */
  constructor(
    private readonly session: () => Session,
    private readonly onFloor: () => void,
  ) {
    this.springs.addEventListener('input', () => this.showSprings());
    this.springs.addEventListener('change', () => this.use());
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
    const own = description.floor.stiffness;
    this.stiffness = [...new Set([...STIFFNESS, ...(own === null ? [] : [own])])].sort((a, b) => a - b);
    this.springs.max = String(this.stiffness.length);
    const at = floor.stiffness === null ? -1 : this.stiffness.indexOf(floor.stiffness);
    this.springs.value = String(at < 0 ? this.stiffness.length : at);
    this.showSprings();
    for (const name of PLAIN) {
      const input = this.input(name);
      // A robot may be heavier than most.
      if (floor[name] > Number(input.max)) input.max = String(floor[name]);
      if (floor[name] < Number(input.min)) input.min = String(floor[name]);
      input.value = String(floor[name]);
      this.show(input, SHOWN[name](floor[name]));
    }
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

  /** The stiffness that the slider is at; null for rigid legs. */
  private get rate(): number | null {
    return this.stiffness[this.springs.valueAsNumber] ?? null;
  }

  private showSprings(): void {
    const { rate } = this;
    this.show(this.springs, rate === null ? 'rigid' : round(rate, 2));
    this.input('preload').disabled = rate === null;
    // With rigid legs they cancel out.
    for (const name of ['friction', 'mass'] as const) this.input(name).disabled = rate === null;
    element('rigid-note').hidden = rate !== null;
  }

  private show(input: HTMLInputElement, text: string): void {
    element(`${input.id}-out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
  }

  private use(): void {
    const number = (name: Plain) => this.input(name).valueAsNumber;
    const floor: Floor = {
      friction: number('friction'),
      ratio: number('ratio'),
      mass: number('mass'),
      stiffness: this.rate,
      preload: number('preload'),
    };
    this.session().setFloor(floor);
    this.onFloor();
  }
}

function describe({ name, rate, dead_band }: ServoModel): string {
  return rate === null ? 'ideal: where the pulse says, at once' : `${name.toUpperCase().replace('SG', 'SG-')}: ${rate}°/s, dead band ${dead_band} µs`;
}
