// Limits the cost of 3D pictures on a machine without a graphics chip. There the CPU paints them, which slows down
// the rest of the page. The time of each picture is measured. After a slow picture, the next one waits for a multiple
// of that time and has a lower resolution.

/** Time within which a graphics chip finishes a picture, ms. */
const QUICK_PICTURE_MS = 34;
/** Pause after a slow picture, as a multiple of its time. */
const PAUSE_FACTOR = 2;
/** Longest pause, ms: while the page is hidden, a picture seems to take very long. */
const LONGEST_PAUSE_MS = 1500;
/** Lowest resolution, as a share of the screen's pixels along each side. */
const MIN_RESOLUTION = 0.5;
/** Factor of the resolution after a slow picture; it rises again by the inverse factor. */
const RESOLUTION_FACTOR = 0.8;
/** Number of quick pictures in a row after which the resolution rises again. */
const QUICK_PICTURES_TO_REFINE = 90;

export class PaintBudget {
  /** Resolution of the next picture, as a share of the screen's pixels along each side. */
  resolution = 1;
  /** Signalled when the last picture is finished; null if none is under way. */
  private fence: WebGLSync | null = null;
  /** Time at which the last picture began, ms. */
  private pictureStart = 0;
  /** Earliest time of the next picture, ms. */
  private nextPictureTime = 0;
  /** Quick pictures in a row. */
  private quickPictures = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Returns true if a picture may be painted now; must be called in every frame of the page. */
  mayPaint(now = performance.now()): boolean {
    const { gl } = this;
    if (this.fence) {
      if (gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
      const elapsedMs = now - this.pictureStart;
      if (elapsedMs > QUICK_PICTURE_MS) {
        this.nextPictureTime = now + Math.min(LONGEST_PAUSE_MS, PAUSE_FACTOR * elapsedMs);
        this.resolution = Math.max(MIN_RESOLUTION, this.resolution * RESOLUTION_FACTOR);
        this.quickPictures = 0;
      } else if (++this.quickPictures % QUICK_PICTURES_TO_REFINE === 0) this.resolution = Math.min(1, this.resolution / RESOLUTION_FACTOR);
    }
    return now >= this.nextPictureTime;
  }

  /** Records that a picture was handed over. If `isOnce`, it is painted only once and may take long: it counts as quick. */
  notePicture(isOnce: boolean, now = performance.now()): void {
    this.pictureStart = isOnce ? Infinity : now;
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }
}
