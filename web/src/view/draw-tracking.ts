// The overlay on the camera's video: the tags, and the robot's path and heading.
import type { Pixel } from '../../generated/measure';
import type { TagTracker } from '../measure/tag-tracker';
import { beginLines, prepareSurface } from './canvas';
import { getPalette } from './palette';

/** Length of the line that shows the heading, relative to the edge of the deck's tag. */
const HEADING_LINE_LENGTH = 1.6;

/**
 * Draws the tags, path and heading over the last frame, which is centred in its element and scaled as with
 * `object-fit: contain`.
 */
export function drawTracking(canvas: HTMLCanvasElement, tracker: TagTracker): void {
  const surface = prepareSurface(canvas);
  if (!surface) return;
  const { context, width, height } = surface;
  const [frameWidth, frameHeight] = tracker.frameSize;
  const scale = Math.min(width / frameWidth, height / frameHeight);
  context.translate((width - scale * frameWidth) / 2, (height - scale * frameHeight) / 2);
  const toCanvas = ([x, y]: Pixel): Pixel => [scale * x, scale * y];
  const { accent, a2 } = getPalette();
  const drawLine = (points: Pixel[], colour: string, lineWidth: number) => {
    beginLines(context, colour, lineWidth);
    for (const [i, point] of points.entries()) context[i === 0 ? 'moveTo' : 'lineTo'](...toCanvas(point));
    context.stroke();
  };
  drawLine(tracker.path, a2, 2);
  // The line ends one side beyond its start, so that the first corner is joined like the others.
  for (const { corners } of tracker.tags) drawLine([...corners, corners[0], corners[1]], accent, 3);
  const [from, heading] = [tracker.path.at(-1), tracker.headingVector];
  if (from && heading) drawLine([from, [from[0] + HEADING_LINE_LENGTH * heading[0], from[1] + HEADING_LINE_LENGTH * heading[1]]], a2, 4);
}
