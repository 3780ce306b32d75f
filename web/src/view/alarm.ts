// The alarm for a robot that does not answer: the page then shows an old state, and the robot may walk on.
import { SILENCE } from '../link/dialogue';
import { element } from './canvas';

export class Alarm {
  private readonly box = element('alarm');
  private isStopping = false;
  /** The time at which the unanswered line was sent, on the page's clock, ms. */
  private since = 0;

  silent(isSilent: boolean): void {
    this.since = performance.now() - SILENCE;
    this.box.hidden = !isSilent;
    this.write();
  }

  stopping(isStopping: boolean): void {
    this.isStopping = isStopping;
    document.body.classList.toggle('stopping', isStopping);
    this.write();
  }

  /** Writes the time since the unanswered line. */
  write(): void {
    if (this.box.hidden) return;
    const message = this.isStopping ? 'No answer: it may walk on. "stop" is sent until it answers.' : 'No answer from the robot.';
    if (element('alarm-said').textContent !== message) element('alarm-said').textContent = message;
    element('alarm-age').textContent = `${((performance.now() - this.since) / 1000).toFixed(1)} s`;
  }
}
