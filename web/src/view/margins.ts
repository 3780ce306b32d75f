// The panel of margins: the distance of the pose from each singularity.
import type { Description, Scene } from '../robot';
import { element } from './canvas';
import { isShown } from './rooms';

export class MarginsView {
  private readonly panel = element<HTMLDetailsElement>('margins-panel');
  private bars: { row: HTMLElement; fill: HTMLElement; value: HTMLElement; limit: number }[] = [];

  robot({ margins }: Description): void {
    const list = element('margins');
    list.replaceChildren();
    this.bars = margins.map(({ name, limit }) => {
      const row = list.appendChild(document.createElement('div'));
      row.className = 'bar';
      const add = (parent: HTMLElement, tag: string, kind = '') => {
        const child = parent.appendChild(document.createElement(tag));
        child.className = kind;
        return child;
      };
      add(row, 'span').textContent = name.replace('_', ' ');
      const track = add(row, 'div', 'track');
      const fill = add(track, 'div', 'fill');
      add(track, 'div', 'limit').style.left = `${limit * 100}%`;
      return { row, fill, value: add(row, 'span'), limit };
    });
  }

  draw(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.bars.forEach(({ row, fill, limit }, n) => {
      const margin = scene?.margins[n]?.value;
      fill.style.transform = `scaleX(${Math.max(0, margin ?? 0).toFixed(3)})`;
      row.classList.toggle('low', margin !== undefined && margin < limit);
    });
  }

  /** Writes the numbers, which costs a layout. */
  write(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.bars.forEach(({ value }, n) => {
      const text = scene?.margins[n]?.value.toFixed(3) ?? '–';
      if (value.textContent !== text) value.textContent = text;
    });
  }
}
