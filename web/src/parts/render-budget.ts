// Limits the cost of 3D rendering on a machine without a GPU, where rendering on the CPU slows down the rest of the
// page. The time of each frame is measured. After a slow frame, the next frame waits for a multiple of this time and
// has a lower resolution.

/** Longest time of a fast frame, ms; a longer frame was probably rendered on the CPU. */
const MAX_FAST_FRAME_MS = 34;
/** Pause after a slow frame, as a multiple of its time. */
const PAUSE_FACTOR = 2;
/** Longest pause, ms; a frame that was submitted while the page was hidden would otherwise cause a very long pause. */
const MAX_PAUSE_MS = 1500;
/** Lowest resolution, as a fraction of the screen's pixels along each side. */
const MIN_RESOLUTION = 0.5;
/** Factor by which a slow frame reduces the resolution; it later rises by the inverse factor. */
const RESOLUTION_FACTOR = 0.8;
/** Number of consecutive fast frames after which the resolution rises again. */
const FAST_FRAME_COUNT_TO_REFINE = 90;

export class RenderBudget {
  /** Resolution of the next frame, as a fraction of the screen's pixels along each side. */
  resolution = 1;
  /** Fence that the GPU signals after the last frame; null if no frame is being rendered. */
  private fence: WebGLSync | null = null;
  /** Time at which the last frame was submitted, ms. */
  private frameStartMs = 0;
  /** Earliest time of the next frame, ms. */
  private nextFrameMs = 0;
  /** Number of consecutive fast frames. */
  private fastFrameCount = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Returns true if a frame may be rendered now; must be called in every animation frame. */
  mayRender(now = performance.now()): boolean {
    const { gl } = this;
    if (this.fence) {
      if (gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
      const elapsedMs = now - this.frameStartMs;
      if (elapsedMs > MAX_FAST_FRAME_MS) {
        this.nextFrameMs = now + Math.min(MAX_PAUSE_MS, PAUSE_FACTOR * elapsedMs);
        this.resolution = Math.max(MIN_RESOLUTION, this.resolution * RESOLUTION_FACTOR);
        this.fastFrameCount = 0;
      } else if (++this.fastFrameCount % FAST_FRAME_COUNT_TO_REFINE === 0) this.resolution = Math.min(1, this.resolution / RESOLUTION_FACTOR);
    }
    return now >= this.nextFrameMs;
  }

  /** Records that a frame was submitted. A single frame counts as fast, because no other frame follows soon. */
  recordFrame(isSingle: boolean, now = performance.now()): void {
    this.frameStartMs = isSingle ? Infinity : now;
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }
}
