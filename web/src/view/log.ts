// The console: the sent and received lines, and an input for a line to send.
import { element, make } from './elements';

/** Largest number of kept lines. */
const MAX_LINES = 400;

export class LogView {
  private readonly lineInput = element<HTMLInputElement>('typed');
  /** The lines that the user has entered, with the latest line at the end. */
  private readonly history: string[] = [];
  /** The history index of the line in the input; the history's length for a new line. */
  private historyIndex = 0;

  constructor(onLine: (line: string) => void) {
    // Lines that arrive while the panel is hidden do not scroll it.
    element('console').addEventListener('toggle', () => element('log').scrollTo(0, element('log').scrollHeight));
    element<HTMLFormElement>('line').addEventListener('submit', (event) => {
      event.preventDefault();
      const line = this.lineInput.value.trim();
      if (line === '') return;
      this.history.push(line);
      this.historyIndex = this.history.length;
      this.lineInput.value = '';
      onLine(line);
    });
    this.lineInput.addEventListener('keydown', (event) => {
      const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      this.historyIndex = Math.min(this.history.length, Math.max(0, this.historyIndex + step));
      this.lineInput.value = this.history[this.historyIndex] ?? '';
    });
  }

  showSent(line: string): void {
    this.add(`> ${line}`, 'sent');
  }

  /** Shows a received line in the style of an error, a note or an answer. */
  showReceived(line: string): void {
    this.add(line, line.startsWith('err') ? 'err' : line.startsWith('#') ? 'note' : 'ok');
  }

  private add(text: string, className: string): void {
    const box = element('log');
    // The view stays for a user who has scrolled up to older lines.
    const isAtEnd = box.scrollHeight - box.scrollTop - box.clientHeight < 24;
    box.append(make('div', { className }, text));
    while (box.childElementCount > MAX_LINES) box.firstElementChild?.remove();
    if (isAtEnd) box.scrollTop = box.scrollHeight;
  }
}
