// Runs the simulation in real time, or slower where the page cannot keep up.

/** Longest simulated time per picture, ms: what a hidden or slow page misses beyond this is skipped. */
const MAX_CATCH_UP_MS = 100;
/** Slice of simulated time, ms; promises are settled between two slices. */
const SLICE_MS = 4;
/** CPU time that the simulation may take for a picture, ms; if it needs more, it falls behind real time. */
const PICTURE_BUDGET_MS = 30;

/**
 * Calls `advance` with the time since the last picture, in slices, and then `draw`, for each picture of the browser.
 */
export function runInRealTime(advance: (ms: number) => void, draw: () => void): void {
  let lastTime: number | null = null;
  let hasFailed = false;
  const handleFrame = async (now: number) => {
    let remainingMs = lastTime === null ? 0 : Math.min(MAX_CATCH_UP_MS, Math.max(0, now - lastTime));
    lastTime = now;
    const start = performance.now();
    try {
      while (remainingMs > 0 && !hasFailed && performance.now() - start < PICTURE_BUDGET_MS) {
        advance(Math.min(SLICE_MS, remainingMs));
        remainingMs -= SLICE_MS;
        await Promise.resolve();
      }
    } catch (error) {
      // The failure is reported once; the page continues without the simulation.
      hasFailed = true;
      console.error(error);
    }
    draw();
    requestAnimationFrame((time) => void handleFrame(time));
  };
  requestAnimationFrame((time) => void handleFrame(time));
}
