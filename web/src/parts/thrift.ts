// Pictures in space without a graphics chip: the processor paints them, beside the page, so that
// the page does not notice how much of the machine it takes. Here is noticed how long a picture takes; the
// next one waits until the processor had several times as long for other things, and has fewer points.

/** A picture that is done within this is a graphics chip's, or as good, ms: it is looked at once a picture. */
const QUICK = 34;
/** So many times as long as a slow picture took, nothing is painted. */
const PAUSE = 2;
/** But no longer than this, ms: a page that was hidden has not looked. */
const LONGEST = 1500;
/** Of the screen's points to a side, at the least. */
const COARSEST = 0.5;
const COARSER = 0.8;
/** After so many quick pictures in a row they may be finer again. */
const STEADY = 90;

export class Thrift {
  /** The share of the screen's points to a side that the next picture has. */
  sharpness = 1;
  private fence: WebGLSync | null = null;
  private begun = 0;
  private next = 0;
  private quick = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Whether another picture may be painted now; to be asked in every picture of the page. */
  may(now = performance.now()): boolean {
    const { gl } = this;
    if (this.fence) {
      if (gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
      const took = now - this.begun;
      if (took > QUICK) {
        this.next = now + Math.min(LONGEST, PAUSE * took);
        this.sharpness = Math.max(COARSEST, this.sharpness * COARSER);
        this.quick = 0;
      } else if (++this.quick % STEADY === 0) this.sharpness = Math.min(1, this.sharpness / COARSER);
    }
    return now >= this.next;
  }

  /** A picture was handed over to be painted; one that is painted once may take long. */
  drawn(once: boolean, now = performance.now()): void {
    this.begun = once ? Infinity : now;
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }
}
