// The slider for the pace of all gaits; it also shows the pace that the robot reports.
import { WORDS } from '../words';
import { element } from './canvas';

export class Pace {
  private readonly slider = element<HTMLInputElement>('speed');
  private readonly out = element('speed-out');
  /** True while the user holds the slider, or the line with its value has no answer. */
  private isHeld = false;

  /** `ask` sends a line and resolves with its answer. */
  constructor(ask: (line: string) => Promise<unknown>) {
    this.slider.addEventListener('input', () => {
      this.isHeld = true;
      this.write(this.slider.valueAsNumber);
    });
    this.slider.addEventListener('change', () => {
      this.isHeld = true;
      void ask(`${WORDS.speed} ${this.slider.value}`).finally(() => (this.isHeld = false));
    });
    this.write(this.slider.valueAsNumber);
  }

  /** Shows the robot's pace, percent. */
  show(percent: number): void {
    if (this.isHeld) return;
    this.slider.value = String(percent);
    this.write(percent);
  }

  /** The pace of the slider, percent. */
  get percent(): number {
    return this.slider.valueAsNumber;
  }

  private write(percent: number): void {
    const text = `${percent} %`;
    if (this.out.textContent === text) return;
    this.out.textContent = text;
    this.slider.setAttribute('aria-valuetext', text);
  }
}
