// The floor that the lizard walks on: to pan and zoom, by pointer, wheel, fingers or keys.
import type { Frame, Place, Plate } from '../robot';
import { element, surface } from './canvas';
import { drawLizard } from './lizard';
import { palette } from './palette';

const GRID = 50;
/** CSS pixels in a mm: the robot, some 250 mm long, stays larger than 60 pixels. */
const LEAST_ZOOM = 0.25;
const MOST_ZOOM = 8;
/** What is to be seen at first, mm. */
const VIEW = 420;
/** Points of the track that are kept, and how far apart they are at least, mm. */
const LONGEST_TRACK = 6000;
const TRACK_STEP = 0.5;

/** A finger that has moved so far aside drags the floor, CSS pixels. */
const SLOP = 12;

interface Touch {
  x: number;
  y: number;
}

export class Floor {
  private readonly canvas = element<HTMLCanvasElement>('floor');
  private readonly followButton = element<HTMLButtonElement>('follow');
  private centre = { x: 0, y: 0 };
  /** CSS pixels in a mm; 0 until the canvas has a size. */
  private zoom = 0;
  private following = true;
  private track: { x: number; y: number }[] = [];
  private readonly touches = new Map<number, Touch>();
  /** Whether the one pointer that is down drags the floor. */
  private dragging = false;

  constructor(onHome: () => void) {
    element('zoom-in').addEventListener('click', () => this.zoomBy(1.25));
    element('zoom-out').addEventListener('click', () => this.zoomBy(0.8));
    element('home').addEventListener('click', () => {
      onHome();
      this.zoom = 0;
      this.follow(true);
    });
    this.followButton.addEventListener('click', () => this.follow(!this.following));
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      this.touches.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    });
    this.canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const kind of ['pointerup', 'pointercancel'] as const) {
      this.canvas.addEventListener(kind, (event) => {
        this.touches.delete(event.pointerId);
        this.dragging = false;
      });
    }
    this.canvas.addEventListener(
      'wheel',
      (event) => {
        // Without Ctrl it scrolls the page, which the floor is in the way of.
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        this.zoomBy(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
      },
      { passive: false },
    );
    this.canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** Forgets the way that was walked. */
  clear(): void {
    this.track = [];
    this.centre = { x: 0, y: 0 };
  }

  /** Notes where the body is. */
  walked({ x, y }: Place): void {
    const last = this.track[this.track.length - 1];
    if (last && Math.hypot(x - last.x, y - last.y) < TRACK_STEP) return;
    this.track.push({ x, y });
    if (this.track.length > LONGEST_TRACK) this.track.splice(0, LONGEST_TRACK / 4);
  }

  draw(plate: Plate, frame: Frame | null): void {
    const area = surface(this.canvas, true);
    if (!area) return;
    const { pen, width, height } = area;
    if (this.zoom === 0) this.zoom = Math.min(width, height) / VIEW;
    if (this.following && frame) {
      // Gently, so that a step does not shake the floor.
      this.centre.x += (frame.place.x - this.centre.x) * 0.08;
      this.centre.y += (frame.place.y - this.centre.y) * 0.08;
    }
    // The picture's scale, for whoever cannot measure it.
    const zoom = this.zoom.toFixed(4);
    if (this.canvas.dataset.zoom !== zoom) this.canvas.dataset.zoom = zoom;
    pen.fillStyle = palette().floor;
    pen.fillRect(0, 0, width, height);
    pen.translate(width / 2, height / 2);
    pen.scale(this.zoom, -this.zoom);
    pen.translate(-this.centre.x, -this.centre.y);
    this.grid(pen, width, height);
    this.way(pen);
    if (frame?.scene) {
      const { x, y, heading } = frame.place;
      pen.save();
      pen.translate(x, y);
      pen.rotate((heading * Math.PI) / 180);
      drawLizard(pen, plate, frame.scene, frame.slides);
      pen.restore();
    }
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    // Above the buttons, where the floor is narrow.
    this.ruler(pen, width < 520 ? height - 46 : height);
  }

  private grid(pen: CanvasRenderingContext2D, width: number, height: number): void {
    const step = this.zoom < 0.4 ? GRID * 5 : GRID;
    const [w, h] = [width / 2 / this.zoom, height / 2 / this.zoom];
    const { x, y } = this.centre;
    pen.strokeStyle = palette().grid;
    pen.lineWidth = 1 / this.zoom;
    pen.beginPath();
    for (let at = Math.ceil((x - w) / step) * step; at <= x + w; at += step) {
      pen.moveTo(at, y - h);
      pen.lineTo(at, y + h);
    }
    for (let at = Math.ceil((y - h) / step) * step; at <= y + h; at += step) {
      pen.moveTo(x - w, at);
      pen.lineTo(x + w, at);
    }
    pen.stroke();
  }

  private way(pen: CanvasRenderingContext2D): void {
    pen.strokeStyle = palette().track;
    pen.lineWidth = 2.5 / this.zoom;
    pen.lineJoin = 'round';
    pen.beginPath();
    this.track.forEach(({ x, y }, n) => (n === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.stroke();
    // The start.
    pen.beginPath();
    pen.arc(0, 0, 4, 0, 2 * Math.PI);
    pen.moveTo(-9, 0);
    pen.lineTo(9, 0);
    pen.moveTo(0, -9);
    pen.lineTo(0, 9);
    pen.stroke();
  }

  private ruler(pen: CanvasRenderingContext2D, height: number): void {
    const length = [10, 50, 100, 500].find((mm) => mm * this.zoom > 50) ?? 1000;
    const [x, y] = [14, height - 22];
    pen.strokeStyle = palette().ink;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x, y - 4);
    pen.lineTo(x, y);
    pen.lineTo(x + length * this.zoom, y);
    pen.lineTo(x + length * this.zoom, y - 4);
    pen.stroke();
    pen.fillStyle = palette().ink;
    pen.font = '12px system-ui, sans-serif';
    pen.fillText(`${length} mm`, x + 4, y - 5);
  }

  private follow(on: boolean): void {
    this.following = on;
    this.followButton.setAttribute('aria-pressed', String(on));
  }

  /** Zooms about a place of the canvas, its middle by default. */
  private zoomBy(factor: number, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2): void {
    const zoom = Math.min(MOST_ZOOM, Math.max(LEAST_ZOOM, this.zoom * factor));
    const [dx, dy] = [x - this.canvas.clientWidth / 2, this.canvas.clientHeight / 2 - y];
    const shift = 1 / this.zoom - 1 / zoom;
    this.centre.x += dx * shift;
    this.centre.y += dy * shift;
    this.zoom = zoom;
  }

  private pan(dx: number, dy: number): void {
    this.follow(false);
    this.centre.x -= dx / this.zoom;
    this.centre.y += dy / this.zoom;
  }

  private drag(event: PointerEvent): void {
    const before = this.touches.get(event.pointerId);
    if (!before) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const other = [...this.touches].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (a: Touch) => Math.hypot(a.x - other.x, a.y - other.y);
      this.zoomBy(apart(now) / Math.max(1, apart(before)), (now.x + other.x) / 2, (now.y + other.y) / 2);
    } else {
      // A finger that means to scroll the page moves a little before the browser takes it away.
      this.dragging ||= event.pointerType !== 'touch' || Math.abs(now.x - before.x) > SLOP;
      if (!this.dragging) return;
      this.pan(now.x - before.x, now.y - before.y);
    }
    this.touches.set(event.pointerId, now);
  }

  private key(event: KeyboardEvent): void {
    const moves: Record<string, () => void> = {
      ArrowLeft: () => this.pan(40, 0),
      ArrowRight: () => this.pan(-40, 0),
      ArrowUp: () => this.pan(0, 40),
      ArrowDown: () => this.pan(0, -40),
      '+': () => this.zoomBy(1.25),
      '-': () => this.zoomBy(0.8),
      Home: () => this.follow(true),
    };
    const move = moves[event.key];
    if (!move) return;
    event.preventDefault();
    move();
  }
}
