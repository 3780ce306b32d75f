// The panel of margins: the distance of the pose from each singularity.
import type { Description, Scene } from '../robot';
import { element } from './canvas';
import { make } from './make';
import { isShown } from './rooms';

export class MarginsView {
  private readonly panel = element<HTMLDetailsElement>('margins-panel');
  private bars: { row: HTMLElement; fill: HTMLElement; value: HTMLElement; limit: number }[] = [];

  setRobot({ margins }: Description): void {
    const list = element('margins');
    list.replaceChildren();
    this.bars = margins.map(({ name, limit }) => {
      const [fill, mark, value] = [make('div', { className: 'fill' }), make('div', { className: 'limit' }), make('span', {})];
      mark.style.left = `${limit * 100}%`;
      const row = make('div', { className: 'bar' }, make('span', {}, name.replace('_', ' ')), make('div', { className: 'track' }, fill, mark), value);
      list.append(row);
      return { row, fill, value, limit };
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

  /** Updates the numbers, for which the browser must lay out the page again. */
  write(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.bars.forEach(({ value }, n) => {
      const text = scene?.margins[n]?.value.toFixed(3) ?? '–';
      if (value.textContent !== text) value.textContent = text;
    });
  }
}
