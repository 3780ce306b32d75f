// Runs code when the page's state changes.
import { effect, type ReadonlySignal, untracked } from '@preact/signals-core';

/** Calls `action` now, and again whenever a signal changes. */
export function follow(signals: ReadonlySignal<unknown>[], action: () => void): void {
  effect(() => {
    // Reading a signal subscribes this effect to it.
    signals.forEach((signal) => signal.value);
    untracked(action);
  });
}
