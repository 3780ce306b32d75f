// The overlay on the camera's picture: the tags, and the robot's path and heading.
import type { Pixel } from '../../generated/measure';
import type { TagTracker } from '../measure/tag-tracker';
import { prepareSurface } from './canvas';
import { palette } from './palette';

/** Length of the arrow for the heading, relative to the size of the deck's tag. */
const ARROW_LENGTH = 1.6;

/**
 * Draws the tags, path and heading over the last picture, which is centred in its element and scaled to fit, as
 * `object-fit: contain` does.
 */
export function drawTracking(canvas: HTMLCanvasElement, tracker: TagTracker): void {
  const surface = prepareSurface(canvas);
  if (!surface) return;
  const { context, width, height } = surface;
  const [pictureWidth, pictureHeight] = tracker.size;
  const scale = Math.min(width / pictureWidth, height / pictureHeight);
  context.translate((width - scale * pictureWidth) / 2, (height - scale * pictureHeight) / 2);
  const toCanvas = ([x, y]: Pixel): Pixel => [scale * x, scale * y];
  const { accent, a2 } = palette();
  const drawLine = (points: Pixel[], colour: string, lineWidth: number) => {
    context.beginPath();
    for (const [i, point] of points.entries()) context[i === 0 ? 'moveTo' : 'lineTo'](...toCanvas(point));
    context.strokeStyle = colour;
    context.lineWidth = lineWidth;
    context.stroke();
  };
  drawLine(tracker.path, a2, 2);
  for (const { corners } of tracker.tags) drawLine([...corners, corners[0], corners[1]], accent, 3);
  const [from, { heading }] = [tracker.path.at(-1), tracker];
  if (from && tracker.deck && heading) drawLine([from, [from[0] + ARROW_LENGTH * heading[0], from[1] + ARROW_LENGTH * heading[1]]], a2, 4);
}
