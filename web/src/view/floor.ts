// The view of the floor on which the robot walks; pointer, wheel, fingers and keys pan and zoom it.
import type { Frame, Place, Plate } from '../robot';
import { addCircle, addPolyline, beginLines, prepareSurface } from './canvas';
import { element } from './elements';
import { drawLizard } from './lizard';
import { onPaletteChange, getPalette } from './palette';

const GRID_SPACING_MM = 50;
/** Smallest zoom, CSS pixels per mm, at which a robot of 250 mm is still 60 pixels long. */
const MIN_ZOOM = 0.25;
/** Largest zoom, CSS pixels per mm. */
const MAX_ZOOM = 8;
/** Smallest width and height of the view while the zoom follows the canvas size. */
const MIN_VIEW_MM = 420;
/** Largest number of points of a track. */
const MAX_TRACK_POINTS = 6000;
/** Smallest distance between two points of a track. */
const MIN_POINT_DISTANCE_MM = 0.5;

/** Distance between the starts of the two robots; the second robot is on the right. */
const SECOND_ROBOT_OFFSET_MM = 280;

/** Distance from the goal at which the view stops moving: less than a tenth of a pixel at the largest zoom. */
const GOAL_TOLERANCE_MM = 0.01;

/** Sideways movement beyond which a finger drags the floor, CSS pixels. */
const DRAG_THRESHOLD_PX = 12;

/** A position on the canvas, CSS pixels, or on the floor, mm. */
interface Position {
  x: number;
  y: number;
}

/** The label of the scale bar and its position. */
type ScaleLabel = Position & { text: string };

export class FloorView {
  private readonly canvas = element<HTMLCanvasElement>('floor');
  private readonly followButton = element<HTMLButtonElement>('follow');
  /** The floor's point in the middle of the canvas, mm in the frame of the robot's start. */
  private centre = { x: 0, y: 0 };
  /** Zoom, CSS pixels per mm; 0 until the canvas has a size. */
  private zoom = 0;
  /** True while the zoom follows the canvas size; false once the user has chosen a zoom. */
  private isZoomAutomatic = true;
  /** True while the view follows the robot. */
  private isFollowing = true;
  /** The tracks of the robot and of the second robot, mm, each in the frame of its own start. */
  private tracks: Position[][] = [[], []];
  /** True if the floor is drawn in every animation frame, even behind the robot in 3D: for a video or a picture. */
  drawsAlways = false;
  /** The plate and the two robots' frames in the last drawing; null before the first drawing. */
  private lastDrawn: [Plate, Frame | null, Frame | null] | null = null;
  /** The inputs of the drawn picture except the colours, as text; empty if the floor must be drawn again. */
  private drawnState = '';
  /** The last positions of the pressed pointers by id. */
  private readonly pressedPointers = new Map<number, Position>();
  /** True while the pointer drags the floor. */
  private isDragging = false;

  /** `onHome` is called when the user resets the view. */
  constructor(onHome: () => void) {
    element('zoom-in').addEventListener('click', () => this.zoomBy(1.25));
    element('zoom-out').addEventListener('click', () => this.zoomBy(0.8));
    element('home').addEventListener('click', () => {
      onHome();
      this.fitView();
    });
    this.followButton.addEventListener('click', () => this.setFollowing(!this.isFollowing));
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      this.pressedPointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    });
    this.canvas.addEventListener('pointermove', (event) => this.handleDrag(event));
    for (const eventName of ['pointerup', 'pointercancel'] as const) {
      this.canvas.addEventListener(eventName, (event) => {
        this.pressedPointers.delete(event.pointerId);
        this.isDragging = false;
      });
    }
    const handleWheel = (event: WheelEvent) => {
      // Without Ctrl, the wheel scrolls the page.
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      this.zoomBy(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
    };
    this.canvas.addEventListener('wheel', handleWheel, { passive: false });
    this.canvas.addEventListener('keydown', (event) => this.handleKey(event));
    const invalidate = () => (this.drawnState = '');
    onPaletteChange(invalidate);
    // A browser that is short of memory may clear canvases.
    this.canvas.addEventListener('contextrestored', invalidate);
  }

  /** Clears the tracks and moves the view to the start. */
  clearTracks(): void {
    this.tracks = [[], []];
    this.centre = { x: 0, y: 0 };
  }

  /** Adds a place to the robot's track or, if `isSecond`, to the second robot's track. */
  addToTrack({ x, y }: Place, isSecond = false): void {
    const track = this.tracks[isSecond ? 1 : 0] ?? [];
    const lastPoint = track[track.length - 1];
    if (lastPoint && Math.hypot(x - lastPoint.x, y - lastPoint.y) < MIN_POINT_DISTANCE_MM) return;
    track.push({ x, y });
    if (track.length > MAX_TRACK_POINTS) track.splice(0, MAX_TRACK_POINTS / 4);
  }

  /**
   * Draws the floor and the robots unless the canvas already shows them: drawing in every animation frame takes half
   * of a slow machine's core.
   */
  draw(plate: Plate, frame: Frame | null, secondFrame: Frame | null): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.lastDrawn = [plate, frame, secondFrame];
    if (this.isZoomAutomatic) this.zoom = Math.min(width / (MIN_VIEW_MM + (secondFrame ? SECOND_ROBOT_OFFSET_MM : 0)), height / MIN_VIEW_MM);
    if (this.isFollowing && frame) this.moveViewTowards(frame.place, secondFrame && secondFrame.place);
    // Tests read the zoom from the dataset.
    const zoom = this.zoom.toFixed(4);
    if (this.canvas.dataset.zoom !== zoom) this.canvas.dataset.zoom = zoom;
    const robots = [frame, secondFrame].map((robot) => robot && [robot.place, robot.scene, robot.slips]);
    const state = JSON.stringify([width, height, devicePixelRatio, this.zoom, this.centre, plate, robots, this.tracks.map((track) => [track.length, track.at(-1)])]);
    if (state === this.drawnState && !this.drawsAlways) return;
    const context = prepareSurface(this.canvas, true)?.context;
    if (!context) return;
    const label = this.drawPicture(context);
    context.fillStyle = getPalette().ink;
    context.font = '12px system-ui, sans-serif';
    context.fillText(label.text, label.x, label.y);
    this.drawnState = state;
  }

  /**
   * Moves the view towards the robot, or towards the midpoint of two robots. The movement is smoothed, so that the gait
   * does not shake the view.
   */
  private moveViewTowards(robotPlace: Place, secondPlace: Place | null): void {
    const goal = secondPlace ? { x: (robotPlace.x + secondPlace.x + SECOND_ROBOT_OFFSET_MM) / 2, y: (robotPlace.y + secondPlace.y) / 2 } : robotPlace;
    const [dx, dy] = [goal.x - this.centre.x, goal.y - this.centre.y];
    const fraction = Math.hypot(dx, dy) < GOAL_TOLERANCE_MM ? 1 : 0.08;
    this.centre = { x: this.centre.x + dx * fraction, y: this.centre.y + dy * fraction };
  }

  /** Makes the view follow the robots and fits the zoom to them. */
  fitView(): void {
    this.isZoomAutomatic = true;
    this.setFollowing(true);
  }

  /**
   * Draws the picture in CSS pixels, with the canvas's own context or with another one for SVG. Returns the scale bar's
   * label, which the caller must add.
   */
  drawPicture(context: CanvasRenderingContext2D): ScaleLabel {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const [plate, frame, secondFrame] = this.lastDrawn ?? [null, null, null];
    context.fillStyle = getPalette().floor;
    context.fillRect(0, 0, width, height);
    context.save();
    context.translate(width / 2, height / 2);
    context.scale(this.zoom, -this.zoom);
    context.translate(-this.centre.x, -this.centre.y);
    this.drawGrid(context, width, height);
    const robots: [number, Frame | null][] = secondFrame ? [[0, frame], [SECOND_ROBOT_OFFSET_MM, secondFrame]] : [[0, frame]];
    robots.forEach(([shift, robot], index) => {
      context.save();
      context.translate(shift, 0);
      this.drawTrack(context, this.tracks[index] ?? []);
      if (plate && robot?.scene) {
        const { x, y, heading } = robot.place;
        context.translate(x, y);
        context.rotate((heading * Math.PI) / 180);
        drawLizard(context, plate, robot.scene, robot.slips);
      }
      context.restore();
    });
    context.restore();
    return this.drawScaleBar(context, height);
  }

  private drawGrid(context: CanvasRenderingContext2D, width: number, height: number): void {
    const spacing = this.zoom < 0.4 ? GRID_SPACING_MM * 5 : GRID_SPACING_MM;
    const [halfWidth, halfHeight] = [width / 2 / this.zoom, height / 2 / this.zoom];
    const { x, y } = this.centre;
    beginLines(context, getPalette().grid, 1 / this.zoom);
    for (let lineX = Math.ceil((x - halfWidth) / spacing) * spacing; lineX <= x + halfWidth; lineX += spacing) {
      addPolyline(context, [lineX, y - halfHeight], [lineX, y + halfHeight]);
    }
    for (let lineY = Math.ceil((y - halfHeight) / spacing) * spacing; lineY <= y + halfHeight; lineY += spacing) {
      addPolyline(context, [x - halfWidth, lineY], [x + halfWidth, lineY]);
    }
    context.stroke();
  }

  private drawTrack(context: CanvasRenderingContext2D, track: Position[]): void {
    context.lineJoin = 'round';
    beginLines(context, getPalette().track, 2.5 / this.zoom);
    track.forEach(({ x, y }, n) => (n === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
    // Marks the start.
    context.beginPath();
    addCircle(context, 0, 0, 4);
    addPolyline(context, [-9, 0], [9, 0]);
    addPolyline(context, [0, -9], [0, 9]);
    context.stroke();
  }

  private drawScaleBar(context: CanvasRenderingContext2D, height: number): ScaleLabel {
    const length = [10, 50, 100, 500].find((mm) => mm * this.zoom > 50) ?? 1000;
    // The scale bar is to the right of the on-screen stick.
    const [x, y] = [124, height - 18];
    beginLines(context, getPalette().ink, 1.5);
    const endX = x + length * this.zoom;
    addPolyline(context, [x, y - 4], [x, y], [endX, y], [endX, y - 4]);
    context.stroke();
    return { text: `${length} mm`, x: x + 4, y: y - 5 };
  }

  private setFollowing(isOn: boolean): void {
    this.isFollowing = isOn;
    this.followButton.setAttribute('aria-pressed', String(isOn));
  }

  /** Zooms about a point of the canvas, by default about its middle. */
  private zoomBy(factor: number, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2): void {
    const zoom = Math.min(MAX_ZOOM, Math.max(MIN_ZOOM, this.zoom * factor));
    const [dx, dy] = [x - this.canvas.clientWidth / 2, this.canvas.clientHeight / 2 - y];
    const shift = 1 / this.zoom - 1 / zoom;
    this.centre.x += dx * shift;
    this.centre.y += dy * shift;
    this.zoom = zoom;
    this.isZoomAutomatic = false;
  }

  private pan(dx: number, dy: number): void {
    this.setFollowing(false);
    this.centre.x -= dx / this.zoom;
    this.centre.y += dy / this.zoom;
  }

  private handleDrag(event: PointerEvent): void {
    const previous = this.pressedPointers.get(event.pointerId);
    if (!previous) return;
    const current = { x: event.offsetX, y: event.offsetY };
    const otherPointer = [...this.pressedPointers].find(([id]) => id !== event.pointerId)?.[1];
    if (otherPointer) {
      const computeDistance = ({ x, y }: Position) => Math.hypot(x - otherPointer.x, y - otherPointer.y);
      this.zoomBy(computeDistance(current) / Math.max(1, computeDistance(previous)), (current.x + otherPointer.x) / 2, (current.y + otherPointer.y) / 2);
    } else {
      // A finger that scrolls the page moves slightly before the browser takes over; this movement does not drag the
      // floor.
      this.isDragging ||= event.pointerType !== 'touch' || Math.abs(current.x - previous.x) > DRAG_THRESHOLD_PX;
      if (!this.isDragging) return;
      this.pan(current.x - previous.x, current.y - previous.y);
    }
    this.pressedPointers.set(event.pointerId, current);
  }

  private handleKey(event: KeyboardEvent): void {
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.pan(40, 0),
      ArrowRight: () => this.pan(-40, 0),
      ArrowUp: () => this.pan(0, 40),
      ArrowDown: () => this.pan(0, -40),
      '+': () => this.zoomBy(1.25),
      '-': () => this.zoomBy(0.8),
      Home: () => this.setFollowing(true),
    };
    const action = actions[event.key];
    if (!action || event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    action();
  }
}
