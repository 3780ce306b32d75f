// The map of singularities of the head's or the tail's five-bar over the angles of its left and right servos, with the
// robot's current pose.
import type { Scene, SingularityMap } from '../robot';
import type { Session } from '../session';
import { beginLines, prepareSurface } from './canvas';
import { element, make } from './elements';
import { onPaletteChange, getPalette } from './palette';

/** Number of poses in the trail. */
const TRAIL_LENGTH = 100;

/** The view of the singularity map of one end, head or tail. */
export class SingularityMapView {
  private readonly canvas: HTMLCanvasElement;
  private map: SingularityMap | null = null;
  private trail: [number, number][] = [];
  /** The map without trail and dot; redrawn if it is null or the canvas has another size. */
  private background: HTMLCanvasElement | null = null;

  /** `endIndex` is 0 for the head and 1 for the tail. */
  constructor(
    session: Session,
    private readonly endIndex: number,
  ) {
    this.canvas = element<HTMLCanvasElement>(`map-${endIndex}`);
    onPaletteChange(() => (this.background = null));
    session.robot.follow(() => {
      this.map = session.robot.wasm.singularityMap(endIndex);
      this.background = null;
      this.trail = [];
    });
  }

  addPose(scene: Scene): void {
    this.trail.push(scene.map_points[this.endIndex]);
    if (this.trail.length > TRAIL_LENGTH) this.trail.shift();
  }

  draw(): void {
    const { map } = this;
    const surface = prepareSurface(this.canvas);
    if (!surface || !map) return;
    const { context, width, height } = surface;
    if (this.background?.width !== this.canvas.width) this.background = this.drawBackground(map);
    context.drawImage(this.background, 0, 0, width, height);
    const scale = width / (map.max_angle - map.min_angle);
    const toPixel = ([left, right]: [number, number]): [number, number] => [
      (left - map.min_angle) * scale,
      height - (right - map.min_angle) * scale,
    ];
    beginLines(context, getPalette().a1, 1.5);
    for (const point of this.trail) context.lineTo(...toPixel(point));
    context.stroke();
    const currentPoint = this.trail[this.trail.length - 1];
    if (!currentPoint) return;
    context.fillStyle = getPalette().a1;
    beginLines(context, getPalette().card, 2);
    context.arc(...toPixel(currentPoint), 5, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }

  private drawBackground(map: SingularityMap): HTMLCanvasElement {
    const { width: size, height } = this.canvas;
    const backgroundCanvas = make('canvas', { width: size, height });
    const context = backgroundCanvas.getContext('2d');
    if (!context) return backgroundCanvas;
    const colours = getPalette();
    context.fillStyle = colours.floor;
    context.fillRect(0, 0, size, size);
    const cellSize = size / (map.size - 1);
    map.margins.forEach((margin, index) => {
      const [column, row] = [Math.floor(index / map.size), index % map.size];
      if (margin === null || margin <= 0) return;
      context.fillStyle = map.safe[index] ? colours.safe : colours.near;
      // Margins are in hundredths.
      context.globalAlpha = map.safe[index] ? 0.45 + Math.min(0.55, margin / 160) : 0.7;
      context.fillRect((column - 0.5) * cellSize, size - (row + 0.5) * cellSize, cellSize + 0.6, cellSize + 0.6);
    });
    context.globalAlpha = 1;
    const scale = size / (map.max_angle - map.min_angle);
    const dotRadius = Math.max(1.2, size / 160);
    for (const { kind, points } of map.curves) {
      context.fillStyle = kind === 'couplers' ? colours.alarm : colours.steel;
      const radiusFactor = kind === 'couplers' ? 2.5 : 1;
      for (const [left, right] of points) {
        context.beginPath();
        context.arc((left - map.min_angle) * scale, size - (right - map.min_angle) * scale, dotRadius * radiusFactor, 0, 2 * Math.PI);
        context.fill();
      }
    }
    return backgroundCanvas;
  }
}
