// The slider of one length. Its range contains the values with which the robot walks; a bar below it marks those whose
// parts can be printed.
import type { Edits, Length } from '../robot';
import { element } from './elements';
import { makeEditsWithTwin } from './tried-lengths';

export class LengthSlider {
  private readonly slider = element<HTMLInputElement>('length-slide');
  private readonly symmetryBox = element<HTMLInputElement>('alike');
  private readonly printableBar = element('length-marks');
  private lengths: Length[] = [];
  /** True once the user has chosen a length; only then does the page search for printable values. */
  hasUserChosen = false;

  /**
   * `tryLengths` is called with the new lengths while the slider is dragged; `isDragEnd` is true at the end of the
   * drag. `onChoice` is called when the user first chooses a length, chooses another one, or turns symmetry on or off.
   * `chosenKey` is the key of the initial length.
   */
  constructor(
    tryLengths: (edits: Edits, isDragEnd: boolean) => void,
    private readonly onChoice: () => void,
    private chosenKey = 'leg.crank',
  ) {
    element('lengths').addEventListener('focusin', ({ target }) => this.choose((target as HTMLInputElement).name));
    this.slider.addEventListener('focus', () => this.choose(this.chosenKey));
    this.symmetryBox.addEventListener('change', () => this.onChoice());
    const showAndTry = (isDragEnd: boolean) => {
      this.showValue(this.slider.valueAsNumber);
      tryLengths(makeEditsWithTwin(this.chosenKey, this.slider.valueAsNumber, this.lengths, this.symmetryBox.checked), isDragEnd);
    };
    this.slider.addEventListener('input', () => showAndTry(false));
    this.slider.addEventListener('change', () => showAndTry(true));
  }

  /** The keys of the lengths that the slider sets: the chosen length and, with symmetry, its twin. */
  get keys(): string[] {
    return makeEditsWithTwin(this.chosenKey, 0, this.lengths, this.symmetryBox.checked).map(([key]) => key);
  }

  private get chosenLength(): Length | undefined {
    return this.lengths.find(({ key }) => key === this.chosenKey);
  }

  /** Shows the chosen length of a robot with these lengths. */
  showRobot(lengths: Length[]): void {
    this.lengths = lengths;
    if (!this.chosenLength) this.chosenKey = lengths[0]?.key ?? '';
    this.show();
  }

  private choose(key: string): void {
    if (key === this.chosenKey && this.hasUserChosen) return;
    this.chosenKey = key;
    this.hasUserChosen = true;
    this.show();
    this.onChoice();
  }

  /** Shows the chosen length, without the bar of the printable values until they are known. */
  private show(): void {
    const { chosenLength } = this;
    element('length-name').textContent = chosenLength?.label ?? '';
    this.showPrintableRange(null, '');
    if (chosenLength) this.showValue(chosenLength.value);
  }

  /** Sets the slider's range to the values with which the robot walks. */
  setRange([min, max]: [number, number]): void {
    Object.assign(this.slider, { min: String(min), max: String(max) });
    if (this.chosenLength) this.showValue(this.chosenLength.value);
  }

  /** Shows the range of printable values (null while it is unknown) and a message. */
  showPrintableRange(range: [number, number] | null, message: string): void {
    element('length-printed').textContent = message;
    this.printableBar.hidden = range === null;
    const { min, max } = this.slider;
    const toPercent = (value: number) => `${(100 * (value - Number(min))) / (Number(max) - Number(min))}%`;
    if (!range) return;
    this.printableBar.style.setProperty('--from', toPercent(range[0]));
    this.printableBar.style.setProperty('--to', toPercent(range[1]));
  }

  private showValue(value: number): void {
    if (this.slider.valueAsNumber !== value) this.slider.value = String(value);
    element('length-out').textContent = `${value} ${this.chosenLength?.unit === 'deg' ? '°' : 'mm'}`;
  }
}
