// Runs the simulation in real time, or slower where the page cannot keep up.

/** Longest simulated time per picture, ms: what a hidden or slow page misses beyond this is skipped. */
const MAX_CATCH_UP_MS = 100;
/** Slice of simulated time, ms; promises are settled between two slices. */
const PART = 4;
/** CPU time that the simulation may take for a picture, ms; if it needs more, it falls behind real time. */
const BUDGET = 30;

export function run(advance: (ms: number) => void, draw: () => void): void {
  let before: number | null = null;
  let failed = false;
  const frame = async (now: number) => {
    let left = before === null ? 0 : Math.min(MAX_CATCH_UP_MS, Math.max(0, now - before));
    before = now;
    const start = performance.now();
    try {
      while (left > 0 && !failed && performance.now() - start < BUDGET) {
        advance(Math.min(PART, left));
        left -= PART;
        await Promise.resolve();
      }
    } catch (error) {
      // The stop is reported once; the page continues.
      failed = true;
      console.error(error);
    }
    draw();
    requestAnimationFrame((next) => void frame(next));
  };
  requestAnimationFrame((first) => void frame(first));
}
