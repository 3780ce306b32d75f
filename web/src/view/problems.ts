// The list of problems, with one line per cause. A line stays until its cause is gone or the user dismisses it.
import type { Cause } from '../problem';
import { button, element, make, paragraph } from './elements';

/** The label and action of a button that solves a problem. */
export interface Remedy {
  label: string;
  action: () => void;
}

export class ProblemList {
  private readonly box = element('problems');
  private readonly lines = new Map<Cause, HTMLElement>();

  /** Replaces the message for a cause; null removes it. */
  setMessage(cause: Cause, message: string | null, remedy: Remedy | null = null): void {
    const previousLine = this.lines.get(cause);
    if (message !== null && previousLine?.firstChild?.textContent === message) return;
    previousLine?.remove();
    this.lines.delete(cause);
    if (message !== null) this.lines.set(cause, this.addLine(cause, message, remedy));
    this.box.hidden = this.lines.size === 0;
  }

  private addLine(cause: Cause, message: string, remedy: Remedy | null): HTMLElement {
    const buttons = [...(remedy ? [button(remedy.label, remedy.action)] : []), button('Dismiss', () => this.setMessage(cause, null))];
    const line = paragraph(make('span', {}, message), ...buttons);
    this.box.append(line);
    return line;
  }
}
