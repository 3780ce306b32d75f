// A button for each gait, with the way that it makes in a cycle.
import type { Description, Robot, Way } from '../robot';
import { element } from './canvas';

/** A way in few letters: mm ahead, or deg where it turns. */
export function short(way: Way | null): string {
  if (!way) return '';
  const parts = [
    way.forward === null ? 'undecided' : Math.abs(way.forward) >= 0.5 ? `${way.forward.toFixed(1)} mm` : '',
    way.turn !== null && Math.abs(way.turn) >= 0.05 ? `${way.turn.toFixed(1)}°` : '',
  ];
  return parts.filter(Boolean).join(', ');
}

export class Drive {
  private readonly list = element('gaits');
  private buttons: { command: string; button: HTMLButtonElement; note: HTMLElement }[] = [];
  private ways = new Map<string, Way>();
  private queue: number[] = [];

  constructor(
    private readonly robot: Robot,
    onCommand: (command: string) => void,
    private readonly onWay: () => void,
  ) {
    document.addEventListener('click', (event) => {
      const button = event.target instanceof Element ? event.target.closest<HTMLElement>('[data-command]') : null;
      if (button?.dataset.command) onCommand(button.dataset.command);
    });
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') onCommand('stop');
    });
  }

  /** Takes another robot. */
  take({ gaits }: Description): void {
    this.list.replaceChildren();
    this.buttons = gaits.map(({ command }) => {
      const button = this.list.appendChild(document.createElement('button'));
      button.type = 'button';
      button.dataset.command = command;
      button.append(command);
      const note = button.appendChild(document.createElement('small'));
      button.setAttribute('aria-pressed', 'false');
      return { command, button, note };
    });
    this.predict();
  }

  /** Predicts every gait anew, one in each pause of the page. */
  predict(): void {
    this.ways.clear();
    const idle = this.queue.length === 0;
    this.queue = this.buttons.map((_, n) => n);
    if (idle) this.later();
  }

  /** The prediction for a command, once it is there. */
  way(command: string): Way | null {
    return this.ways.get(command) ?? null;
  }

  doing(command: string): void {
    for (const { button, command: own } of this.buttons) {
      button.setAttribute('aria-pressed', String(own === command));
    }
  }

  private later(): void {
    setTimeout(() => {
      const gait = this.queue.shift();
      if (gait === undefined) return;
      const entry = this.buttons[gait];
      const way = entry && this.robot.predict(gait);
      if (way) {
        this.ways.set(entry.command, way);
        entry.note.textContent = short(way);
        this.onWay();
      }
      if (this.queue.length > 0) this.later();
    }, 60);
  }
}
