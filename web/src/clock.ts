// Real time for the simulation: as much of it passes as on the wall, and not more than the
// page can keep up with.

/** A page that was hidden or slow does not make up for more than this, ms. */
const MOST = 100;

export function run(advance: (ms: number) => void, draw: () => void): void {
  let before: number | null = null;
  const frame = (now: number) => {
    const passed = before === null ? 0 : Math.min(MOST, Math.max(0, now - before));
    before = now;
    advance(passed);
    draw();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}
