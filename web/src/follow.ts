// Follows the page's state.
import { effect, type ReadonlySignal, untracked } from '@preact/signals-core';

/** Calls `act` now, and again whenever one of the signals has changed. */
export function follow(signals: ReadonlySignal<unknown>[], act: () => void): void {
  effect(() => {
    // Reading a signal makes this effect follow it.
    signals.forEach((signal) => signal.value);
    untracked(act);
  });
}
