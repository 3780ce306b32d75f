// A robot that does not answer: what the page shows of it is old, and it may walk on. So this is said large.
import { SILENCE } from '../link/dialogue';
import { element } from './canvas';

export class Alarm {
  private readonly box = element('alarm');
  private isStopping = false;
  /** When the line was sent that has no answer, on the page's clock, ms. */
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

  /** Writes for how long no answer has come. */
  write(): void {
    if (this.box.hidden) return;
    const said = this.isStopping ? 'No answer: it may walk on. "stop" is sent until it answers.' : 'No answer from the robot.';
    if (element('alarm-said').textContent !== said) element('alarm-said').textContent = said;
    element('alarm-age').textContent = `${((performance.now() - this.since) / 1000).toFixed(1)} s`;
  }
}
