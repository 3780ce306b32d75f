// The overlay on the camera's picture: tags, the robot's path, its heading.
import type { Pixel } from '../../generated/measure';
import type { TagTracker } from '../measure/seen';
import { surface } from './canvas';
import { palette } from './palette';

/** Length of the arrow relative to the deck's tag. */
const ARROW_LENGTH = 1.6;

/** Draws over a picture that is centred in its element and scaled to fit, as `object-fit: contain` does. */
export function drawSight(canvas: HTMLCanvasElement, seen: TagTracker): void {
  const view = surface(canvas);
  if (!view) return;
  const { pen, width, height } = view;
  const [pictureWidth, pictureHeight] = seen.size;
  const scale = Math.min(width / pictureWidth, height / pictureHeight);
  pen.translate((width - scale * pictureWidth) / 2, (height - scale * pictureHeight) / 2);
  const toCanvas = ([x, y]: Pixel): Pixel => [scale * x, scale * y];
  const { accent, a2 } = palette();
  const drawLine = (points: Pixel[], colour: string, lineWidth: number) => {
    pen.beginPath();
    for (const [i, point] of points.entries()) pen[i === 0 ? 'moveTo' : 'lineTo'](...toCanvas(point));
    pen.strokeStyle = colour;
    pen.lineWidth = lineWidth;
    pen.stroke();
  };
  drawLine(seen.path, a2, 2);
  for (const { corners } of seen.tags) drawLine([...corners, corners[0], corners[1]], accent, 3);
  const [from, { heading }] = [seen.path.at(-1), seen];
  if (from && seen.deck && heading) drawLine([from, [from[0] + ARROW_LENGTH * heading[0], from[1] + ARROW_LENGTH * heading[1]]], a2, 4);
}
