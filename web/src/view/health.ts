// The panel of the robot's status, which the page requests twice per second while it is visible.
import type { Status } from '../robot';
import type { Session } from '../session';
import { element, make, setText } from './elements';
import { isShown } from './rooms';
import type { BoardWriter } from './writer';

const REQUEST_PERIOD_MS = 500;

/** Formatters of the panel's values, by the values' labels. */
const FORMATTERS: Record<string, (status: Status) => string> = {
  fault: ({ fault }) => fault ?? 'none',
  guard: ({ isHeld }) => (isHeld ? 'held' : 'clear'),
  margin: ({ margin }) => margin?.toFixed(3) ?? '–',
  vcc: ({ vcc }) => (vcc === null ? '–' : `${vcc.toFixed(2)} V`),
  'late edges': ({ lateEdges }) => String(lateEdges),
  'bytes lost': ({ lostBytes }) => String(lostBytes),
  'last reset': ({ resetCause }) => resetCause,
  restarts: ({ resetCount }) => String(resetCount),
};

export class HealthView {
  private readonly panel = element<HTMLDetailsElement>('power');
  private readonly values = Object.entries(FORMATTERS).map(([label, format]) => ({ label, format, box: make('dd', {}, '–') }));
  /** True while a request has no answer. */
  private isPending = false;

  constructor(
    private readonly session: Session,
    private readonly writer: BoardWriter,
  ) {
    element('health').append(...this.values.map(({ label, box }) => make('div', {}, make('dt', {}, label), box)));
    setInterval(() => void this.requestStatus(), REQUEST_PERIOD_MS);
  }

  private async requestStatus(): Promise<void> {
    if (this.isPending || this.writer.isBusy.value || document.hidden || !this.session.mayAsk) return;
    this.isPending = true;
    const status = await this.session.status();
    this.isPending = false;
    if (status && isShown(this.panel)) for (const { box, format } of this.values) setText(box, format(status));
  }
}
