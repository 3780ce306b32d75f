// The overlay on the camera's picture: tags, the robot's path, its heading.
import type { Pixel } from '../../generated/measure';
import type { TagTracker } from '../measure/seen';
import { surface } from './canvas';
import { palette } from './palette';

/** Length of the arrow relative to the deck's tag. */
const ARROW = 1.6;

/** Draws over a picture that is centred in its element and scaled to fit, as `object-fit: contain` does. */
export function drawSight(canvas: HTMLCanvasElement, seen: TagTracker): void {
  const view = surface(canvas);
  if (!view) return;
  const { pen, width, height } = view;
  const [w, h] = seen.size;
  const scale = Math.min(width / w, height / h);
  pen.translate((width - scale * w) / 2, (height - scale * h) / 2);
  const at = ([x, y]: Pixel): Pixel => [scale * x, scale * y];
  const { accent, a2 } = palette();
  const line = (points: Pixel[], colour: string, thick: number) => {
    pen.beginPath();
    for (const [i, point] of points.entries()) pen[i === 0 ? 'moveTo' : 'lineTo'](...at(point));
    pen.strokeStyle = colour;
    pen.lineWidth = thick;
    pen.stroke();
  };
  line(seen.path, a2, 2);
  for (const { corners } of seen.tags) line([...corners, corners[0], corners[1]], accent, 3);
  const [from, { heading }] = [seen.path.at(-1), seen];
  if (from && seen.deck && heading) line([from, [from[0] + ARROW * heading[0], from[1] + ARROW * heading[1]]], a2, 4);
}
