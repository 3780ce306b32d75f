// Runs the simulation in real time, or slower if the machine cannot keep up.

/** Longest simulated time per animation frame, ms; a hidden or slow page skips the rest. */
const MAX_CATCH_UP_MS = 100;
/** Slice of simulated time, ms; promise callbacks run between two slices. */
const SLICE_MS = 4;
/** CPU time limit of the simulation per animation frame, ms; beyond it, the simulation falls behind real time. */
const FRAME_BUDGET_MS = 30;

/**
 * In each animation frame, calls `advance` with slices of the time since the previous frame, and then `draw`. `advance`
 * may not throw; an error of `draw` is passed to `onDrawError`.
 */
export function runInRealTime(advance: (ms: number) => void, draw: () => void, onDrawError: (error: unknown) => void): void {
  let previousTime: number | null = null;
  const handleFrame = async (now: number) => {
    let remainingMs = previousTime === null ? 0 : Math.min(MAX_CATCH_UP_MS, Math.max(0, now - previousTime));
    previousTime = now;
    const start = performance.now();
    while (remainingMs > 0 && performance.now() - start < FRAME_BUDGET_MS) {
      advance(Math.min(SLICE_MS, remainingMs));
      remainingMs -= SLICE_MS;
      await Promise.resolve();
    }
    try {
      draw();
    } catch (error) {
      onDrawError(error);
    }
    requestAnimationFrame((time) => void handleFrame(time));
  };
  requestAnimationFrame((time) => void handleFrame(time));
}
