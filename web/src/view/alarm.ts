// The alarm for a robot that does not answer: the page then shows an outdated state, and the robot may still walk.
import type { Session } from '../session';
import { SILENCE_MS } from '../link/dialogue';
import { element, setText } from './elements';

export class AlarmView {
  private readonly box = element('alarm');
  /** The time at which the first unanswered line was sent, on the page's clock, ms. */
  private lineSentAt = 0;

  constructor(private readonly session: Session) {
    session.state.isSilent.subscribe((isSilent) => this.setSilent(isSilent));
    session.state.isStopping.subscribe((isStopping) => {
      document.body.classList.toggle('stopping', isStopping);
      this.update();
    });
  }

  /** Shows the alarm if a line is unanswered, and hides it otherwise. */
  private setSilent(isSilent: boolean): void {
    this.lineSentAt = performance.now() - SILENCE_MS;
    this.box.hidden = !isSilent;
    this.update();
  }

  /** Updates the message and the age of the unanswered line. */
  update(): void {
    if (this.box.hidden) return;
    const message = this.session.state.isStopping.value ? 'No answer: the robot may still walk. The page repeats "stop" until it answers.' : 'No answer from the robot.';
    setText(element('alarm-message'), message);
    element('alarm-age').textContent = `${((performance.now() - this.lineSentAt) / 1000).toFixed(1)} s`;
  }
}
