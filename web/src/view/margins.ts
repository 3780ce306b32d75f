// The panel of the margins, the distances between the pose and the singularities.
import type { Scene } from '../robot';
import type { Session } from '../session';
import { element, make, setText } from './elements';
import { isShown } from './rooms';

export class MarginsView {
  private readonly panel = element<HTMLDetailsElement>('margins-panel');
  private bars: { row: HTMLElement; fill: HTMLElement; value: HTMLElement; limit: number }[] = [];

  constructor(session: Session) {
    // Each margin has a bar, with a mark at its limit.
    session.robot.follow(({ margins }) => {
      this.bars = margins.map(({ name, limit }) => {
        const [fill, mark, value] = [make('div', { className: 'fill' }), make('div', { className: 'limit' }), make('span', {})];
        mark.style.left = `${limit * 100}%`;
        const row = make('div', { className: 'bar' }, make('span', {}, name.replace('_', ' ')), make('div', { className: 'track' }, fill, mark), value);
        return { row, fill, value, limit };
      });
      element('margins').replaceChildren(...this.bars.map(({ row }) => row));
    });
  }

  /** Draws the bars for a pose; null if the pose is unknown. */
  draw(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.bars.forEach(({ row, fill, limit }, index) => {
      const margin = scene?.margins[index]?.value;
      fill.style.transform = `scaleX(${Math.max(0, margin ?? 0).toFixed(3)})`;
      row.classList.toggle('low', margin !== undefined && margin < limit);
    });
  }

  /** Updates the numbers; called less often than `draw`, because each change of a text causes a layout. */
  updateNumbers(scene: Scene | null): void {
    if (!isShown(this.panel)) return;
    this.bars.forEach(({ value }, index) => setText(value, scene?.margins[index]?.value.toFixed(3) ?? '–'));
  }
}
