// The panel of the robot's status. While the page is visible, it requests the status twice per second.
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

export function setUpHealth(session: Session, writer: BoardWriter): void {
  const panel = element<HTMLDetailsElement>('power');
  const values = Object.entries(FORMATTERS).map(([label, format]) => ({ label, format, box: make('dd', {}, '–') }));
  element('health').append(...values.map(({ label, box }) => make('div', {}, make('dt', {}, label), box)));
  /** True while a request has no answer. */
  let isPending = false;
  const requestStatus = async () => {
    if (isPending || writer.isBusy.value || document.hidden || !session.board.mayAsk) return;
    isPending = true;
    const status = await session.board.status();
    isPending = false;
    if (status && isShown(panel)) for (const { box, format } of values) setText(box, format(status));
  };
  setInterval(() => void requestStatus(), REQUEST_PERIOD_MS);
}
