// A button for each gait, with its predicted displacement per cycle.
import type { Description, Outlook, Way } from '../robot';
import type { Answer } from '../link/dialogue';
import { WORDS } from '../words';
import { element } from './canvas';

/** Letters that fit on a button of the usual width. */
const LONG = 13;
/** The longest text of a prediction; a button reserves room for it. */
const LONGEST = '-999.9 mm, -99.9°';

/** A displacement in few letters: mm forward, and deg if it turns. */
export function short(way: Way | null): string {
  if (!way) return '';
  const parts = [
    way.forward === null ? 'undetermined' : Math.abs(way.forward) >= 0.5 ? `${way.forward.toFixed(1)} mm` : '',
    way.turn !== null && Math.abs(way.turn) >= 0.05 ? `${way.turn.toFixed(1)}°` : '',
  ];
  return parts.filter(Boolean).join(', ');
}

export class Drive {
  private readonly list = element('gaits');
  private buttons: { command: string; button: HTMLButtonElement; note: HTMLElement }[] = [];
  private readonly outlooks = new Map<string, Outlook>();

  private readonly said = element('drive-said');
  /** The commands of the buttons in index.html, which every robot has. */
  readonly words: string[] = [...document.querySelectorAll<HTMLElement>('[data-command]')].map(({ dataset }) => dataset.command ?? '');

  /** Takes a function that sends a line and returns its answer, or null without one. */
  constructor(private readonly send: (line: string) => Promise<Answer | null>) {
    document.addEventListener('click', (event) => {
      const button = event.target instanceof Element ? event.target.closest<HTMLElement>('[data-command]') : null;
      if (button?.dataset.command) void this.ask(button.dataset.command);
    });
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') void this.ask(WORDS.stop);
    });
  }

  /** Sends a button's line; a refusal is shown beside the buttons until a line is accepted. */
  async ask(line: string): Promise<void> {
    const answer = await this.send(line);
    if (!answer) return;
    this.said.hidden = answer.ok;
    this.said.textContent = answer.ok ? '' : `${line}: ${answer.text.replace(/^err \d+ /, '')}`;
    if (!answer.ok) this.said.scrollIntoView({ block: 'nearest' });
  }

  /** Takes another robot. */
  take({ gaits }: Description): void {
    this.list.replaceChildren();
    this.buttons = gaits.map(({ command, moves }) => {
      const button = this.list.appendChild(document.createElement('button'));
      button.type = 'button';
      button.dataset.command = command;
      button.append(command);
      // A long name gets the room of two buttons.
      button.classList.toggle('long', command.length > LONG);
      const room = button.appendChild(document.createElement('small'));
      if (moves) room.dataset.room = LONGEST;
      const note = room.appendChild(document.createElement('span'));
      button.setAttribute('aria-pressed', 'false');
      return { command, button, note };
    });
    this.outlooks.clear();
    this.said.hidden = true;
  }

  /** Shows the prediction of a gait; the old one stays until then. */
  predicted(gait: number, outlook: Outlook): void {
    const entry = this.buttons[gait];
    if (!entry) return;
    this.outlooks.set(entry.command, outlook);
    entry.note.textContent = short(outlook);
  }

  /** The prediction for a command; null until it is known. */
  outlook(command: string): Outlook | null {
    return this.outlooks.get(command) ?? null;
  }

  /** The gaits with a known prediction. */
  ways(): { command: string; way: Outlook }[] {
    return this.buttons.flatMap(({ command }) => {
      const way = this.outlooks.get(command);
      return way ? [{ command, way }] : [];
    });
  }

  doing(command: string): void {
    for (const { button, command: own } of this.buttons) {
      button.setAttribute('aria-pressed', String(own === command));
    }
  }
}
