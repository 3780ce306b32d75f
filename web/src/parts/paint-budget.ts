// Limits the cost of 3D pictures on a machine without a graphics chip. There the processor paints them beside the
// page. The time of a picture is measured; the next one waits for a multiple of that time and has fewer points.

/** Time within which a graphics chip finishes a picture, ms. */
const QUICK = 34;
/** Pause after a slow picture, as a multiple of its time. */
const PAUSE = 2;
/** Longest pause, ms, since a hidden page measures times that are too long. */
const LONGEST = 1500;
/** Lowest resolution, as a share of the screen's points to a side. */
const COARSEST = 0.5;
const COARSER = 0.8;
/** Quick pictures in a row after which the resolution rises again. */
const STEADY = 90;

export class PaintBudget {
  /** Resolution of the next picture, as a share of the screen's points to a side. */
  resolution = 1;
  private fence: WebGLSync | null = null;
  private start = 0;
  private next = 0;
  private quick = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Returns true if a picture may be painted now; must be called in every frame of the page. */
  mayPaint(now = performance.now()): boolean {
    const { gl } = this;
    if (this.fence) {
      if (gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
      const elapsed = now - this.start;
      if (elapsed > QUICK) {
        this.next = now + Math.min(LONGEST, PAUSE * elapsed);
        this.resolution = Math.max(COARSEST, this.resolution * COARSER);
        this.quick = 0;
      } else if (++this.quick % STEADY === 0) this.resolution = Math.min(1, this.resolution / COARSER);
    }
    return now >= this.next;
  }

  /** Notes that a picture was handed over; a picture painted `once` may take long. */
  notePicture(once: boolean, now = performance.now()): void {
    this.start = once ? Infinity : now;
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }
}
