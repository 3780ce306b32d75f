// What is wrong, a line for each cause. It stays until the cause is gone or a person puts it away.
import type { Cause } from '../trouble';
import { element } from './canvas';

/** What a person may do about it. */
export interface Remedy {
  label: string;
  act: () => void;
}

export class Troubles {
  private readonly box = element('trouble');
  private readonly lines = new Map<Cause, HTMLElement>();

  /** Shows a sentence in place of the one before about this cause; null where the cause is gone. */
  say(cause: Cause, sentence: string | null, remedy: Remedy | null = null): void {
    const before = this.lines.get(cause);
    if (sentence !== null && before?.firstChild?.textContent === sentence) return;
    before?.remove();
    this.lines.delete(cause);
    if (sentence !== null) this.lines.set(cause, this.line(cause, sentence, remedy));
    this.box.hidden = this.lines.size === 0;
  }

  private line(cause: Cause, sentence: string, remedy: Remedy | null): HTMLElement {
    const line = this.box.appendChild(document.createElement('p'));
    line.appendChild(document.createElement('span')).textContent = sentence;
    const button = (label: string, act: () => void) => {
      const made = line.appendChild(document.createElement('button'));
      made.type = 'button';
      made.textContent = label;
      made.addEventListener('click', act);
    };
    if (remedy) button(remedy.label, remedy.act);
    button('Put away', () => this.say(cause, null));
    return line;
  }
}
