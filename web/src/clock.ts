// Real time for the simulation: as much of it passes as on the wall, and not more than the
// page can keep up with.

/** A page that was hidden or slow does not make up for more than this, ms. */
const MOST = 100;
/** The simulation is run in parts of this, ms; between two of them, answers are answered. */
const PART = 4;
/** It takes no more of a picture's time than this, ms; then it falls behind the wall. */
const BUDGET = 30;

export function run(advance: (ms: number) => void, draw: () => void): void {
  let before: number | null = null;
  let failed = false;
  const frame = async (now: number) => {
    let left = before === null ? 0 : Math.min(MOST, Math.max(0, now - before));
    before = now;
    const begun = performance.now();
    try {
      while (left > 0 && !failed && performance.now() - begun < BUDGET) {
        advance(Math.min(PART, left));
        left -= PART;
        await Promise.resolve();
      }
    } catch (error) {
      // What has stopped is said once; the page goes on.
      failed = true;
      console.error(error);
    }
    draw();
    requestAnimationFrame((next) => void frame(next));
  };
  requestAnimationFrame((first) => void frame(first));
}
