// The alarm for a robot that does not answer: the page then shows an old state, and the robot may walk on.
import { SILENCE_MS } from '../link/dialogue';
import { element } from './canvas';

export class Alarm {
  private readonly box = element('alarm');
  private isStopping = false;
  /** The time at which the unanswered line was sent, on the page's clock, ms. */
  private lineSentAt = 0;

  /** Shows the alarm if the robot has left a line unanswered, and hides it otherwise. */
  setSilent(isSilent: boolean): void {
    this.lineSentAt = performance.now() - SILENCE_MS;
    this.box.hidden = !isSilent;
    this.update();
  }

  /** Takes whether `stop` is being sent and has no answer yet. */
  setStopping(isStopping: boolean): void {
    this.isStopping = isStopping;
    document.body.classList.toggle('stopping', isStopping);
    this.update();
  }

  /** Updates the message and the time since the unanswered line. */
  update(): void {
    if (this.box.hidden) return;
    const message = this.isStopping ? 'No answer: it may walk on. "stop" is sent until it answers.' : 'No answer from the robot.';
    if (element('alarm-said').textContent !== message) element('alarm-said').textContent = message;
    element('alarm-age').textContent = `${((performance.now() - this.lineSentAt) / 1000).toFixed(1)} s`;
  }
}
