// The console: the lines that were sent and received, and an input for a line.
import { element } from './canvas';
import { make } from './make';

/** Largest number of lines that are kept. */
const MAX_LINES = 400;

export class Log {
  private readonly box = element('log');
  private readonly typed = element<HTMLInputElement>('typed');
  private readonly history: string[] = [];
  private at = 0;

  constructor(onLine: (line: string) => void) {
    element<HTMLFormElement>('line').addEventListener('submit', (event) => {
      event.preventDefault();
      const line = this.typed.value.trim();
      if (line === '') return;
      this.history.push(line);
      this.at = this.history.length;
      this.typed.value = '';
      onLine(line);
    });
    this.typed.addEventListener('keydown', (event) => {
      const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      this.at = Math.min(this.history.length, Math.max(0, this.at + step));
      this.typed.value = this.history[this.at] ?? '';
    });
  }

  sent(line: string): void {
    this.add(`> ${line}`, 'sent');
  }

  received(line: string): void {
    this.add(line, line.startsWith('err') ? 'err' : line.startsWith('#') ? 'note' : 'ok');
  }

  private add(text: string, className: string): void {
    const { box } = this;
    // A reader who scrolled up is not disturbed.
    const isAtEnd = box.scrollHeight - box.scrollTop - box.clientHeight < 24;
    box.append(make('div', { className }, text));
    while (box.childElementCount > MAX_LINES) box.firstElementChild?.remove();
    if (isAtEnd) box.scrollTop = box.scrollHeight;
  }
}
