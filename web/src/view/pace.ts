// The slider for the pace of all gaits, which also shows the reported pace.
import type { Session } from '../session';
import { WORDS } from '../words';
import { element } from './elements';

export class PaceView {
  private readonly slider = element<HTMLInputElement>('speed');
  private readonly valueText = element('speed-out');
  /** True between the user's first move of the slider and the answer to the line with its value. */
  private isPending = false;

  constructor(session: Session) {
    this.slider.addEventListener('input', () => {
      this.isPending = true;
      this.showText(this.slider.valueAsNumber);
    });
    this.slider.addEventListener('change', () => {
      this.isPending = true;
      void session.drive(`${WORDS.speed} ${this.slider.value}`).finally(() => {
        this.isPending = false;
        this.show(session.pace);
      });
    });
    session.state.pace.subscribe((percent) => this.show(percent));
  }

  /** Shows the robot's pace in percent, unless the user is changing it. */
  private show(percent: number): void {
    if (this.isPending) return;
    this.slider.value = String(percent);
    this.showText(percent);
  }

  private showText(percent: number): void {
    const text = `${percent} %`;
    if (this.valueText.textContent === text) return;
    this.valueText.textContent = text;
    this.slider.setAttribute('aria-valuetext', text);
  }
}
