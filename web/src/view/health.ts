// The panel of the robot's status, which is requested twice a second while the page is visible.
import type { Status } from '../robot';
import type { Session } from '../session';
import { element, setText } from './canvas';
import { make } from './make';
import { isShown } from './rooms';
import type { Writer } from './writer';

const REQUEST_PERIOD_MS = 500;

export class Health {
  private readonly panel = element<HTMLDetailsElement>('power');
  private readonly list = element('health');
  private readonly values = new Map<string, HTMLElement>();
  /** True from a request until its answer. */
  private isAsking = false;

  constructor(
    private readonly session: Session,
    private readonly writer: Writer,
  ) {
    for (const name of ['fault', 'guard', 'margin', 'vcc', 'late edges', 'bytes lost', 'last reset', 'restarts']) {
      const value = make('dd', {}, '–');
      this.list.append(make('div', {}, make('dt', {}, name), value));
      this.values.set(name, value);
    }
    setInterval(() => void this.requestStatus(), REQUEST_PERIOD_MS);
  }

  private async requestStatus(): Promise<void> {
    if (this.isAsking || this.writer.isBusy.value || document.hidden || !this.session.mayAsk) return;
    this.isAsking = true;
    const status = await this.session.status();
    this.isAsking = false;
    if (status) this.show(status);
  }

  private show(status: Status): void {
    if (!isShown(this.panel)) return;
    const texts: Record<string, string> = {
      fault: status.fault ?? 'none',
      guard: status.isHeld ? 'held' : 'clear',
      margin: status.margin === null ? '–' : status.margin.toFixed(3),
      vcc: status.vcc === null ? '–' : `${status.vcc.toFixed(2)} V`,
      'late edges': String(status.lateEdges),
      'bytes lost': String(status.lostBytes),
      'last reset': status.resetCause,
      restarts: String(status.resetCount),
    };
    for (const [name, text] of Object.entries(texts)) {
      const value = this.values.get(name);
      if (value) setText(value, text);
    }
  }
}
