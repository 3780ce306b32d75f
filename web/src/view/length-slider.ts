// A slider for one length. It covers the values with which the robot walks; the values whose parts can be printed are
// marked.
import type { Edits, Length } from '../robot';
import { element } from './canvas';
import { withTwin } from './tried-lengths';

/** Called with the slider's lengths while it is dragged, and with `isLast` at the end of the drag. */
export type TryOut = (edits: Edits, isLast: boolean) => void;

export class LengthSlider {
  private readonly slide = element<HTMLInputElement>('length-slide');
  private readonly out = element('length-out');
  private readonly symmetric = element<HTMLInputElement>('alike');
  private readonly printed = element('length-printed');
  private readonly marks = element('length-marks');
  private lengths: Length[] = [];
  /** True once the user has chosen a length; until then no time is spent on proving which values can be printed. */
  isChosen = false;

  /** `onChoice` is called when the user chooses another length, or switches the symmetry of left and right. */
  constructor(
    tryOut: TryOut,
    private readonly onChoice: () => void,
    private key = 'leg.crank',
  ) {
    element('lengths').addEventListener('focusin', ({ target }) => this.choose((target as HTMLInputElement).name));
    this.slide.addEventListener('focus', () => this.choose(this.key));
    this.symmetric.addEventListener('change', () => this.onChoice());
    const handleMove = (isLast: boolean) => {
      this.write(this.slide.valueAsNumber);
      tryOut(withTwin(this.key, this.slide.valueAsNumber, this.lengths, this.symmetric.checked), isLast);
    };
    this.slide.addEventListener('input', () => handleMove(false));
    this.slide.addEventListener('change', () => handleMove(true));
  }

  /** The keys of the lengths that the slider sets: the chosen length and, with symmetry, its twin. */
  get keys(): string[] {
    return withTwin(this.key, 0, this.lengths, this.symmetric.checked).map(([key]) => key);
  }

  private get length(): Length | undefined {
    return this.lengths.find(({ key }) => key === this.key);
  }

  showRobot(lengths: Length[]): void {
    this.lengths = lengths;
    if (!this.length) this.key = lengths[0]?.key ?? '';
    this.show();
  }

  private choose(key: string): void {
    if (key === this.key && this.isChosen) return;
    this.key = key;
    this.isChosen = true;
    this.show();
    this.onChoice();
  }

  private show(): void {
    const { length } = this;
    element('length-name').textContent = length?.label ?? '';
    this.mark(null, '');
    if (length) this.write(length.value);
  }

  /** Sets the slider's range: the least and the greatest value with which the robot walks. */
  setRange([smallest, largest]: [number, number]): void {
    Object.assign(this.slide, { min: String(smallest), max: String(largest) });
    if (this.length) this.write(this.length.value);
  }

  /** Marks the values that can be printed and shows a message; null while the values are unknown. */
  mark(range: [number, number] | null, message: string): void {
    this.printed.textContent = message;
    this.marks.hidden = range === null;
    const { min, max } = this.slide;
    const percentOf = (value: number) => `${(100 * (value - Number(min))) / (Number(max) - Number(min))}%`;
    if (!range) return;
    this.marks.style.setProperty('--from', percentOf(range[0]));
    this.marks.style.setProperty('--to', percentOf(range[1]));
  }

  private write(value: number): void {
    if (this.slide.valueAsNumber !== value) this.slide.value = String(value);
    this.out.textContent = `${value} ${this.length?.unit === 'deg' ? '°' : 'mm'}`;
  }
}
