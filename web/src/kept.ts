// Keeps the user's changes across a reload, in the browser's storage.
import type { Floor } from './robot';

/** A robot and the user's changes to it. */
export interface SavedChanges {
  /** The name of its file. */
  file: string;
  /** The robot.toml of the file at that time: the changes apply only to this text. */
  original: string;
  /** The robot.toml with its changes. */
  toml: string;
  /** Floor, mass, feet and drive as set in the page; null for those of robot.toml. */
  floor: Floor | null;
  servos: string;
  volts: number;
}

/** Pages of another address on the same server have their own. */
const KEY = `lizard ${location.pathname}`;

export const kept = {
  /** Stores it; a browser without storage loses it at a reload. */
  put(state: SavedChanges): void {
    try {
      localStorage.setItem(KEY, JSON.stringify(state));
    } catch (error) {
      console.info(`Changes are not kept over a reload: ${String(error)}`);
    }
  },

  /** The stored state; null if there is none that can be used. */
  get(): SavedChanges | null {
    try {
      const state = JSON.parse(localStorage.getItem(KEY) ?? 'null') as SavedChanges | null;
      if (!state || typeof state.toml !== 'string' || typeof state.file !== 'string') return null;
      // An earlier page stored springs in another form, which is dropped.
      const isKnown = typeof state.floor?.twist === 'number' && ['rigid', 'strut'].includes(state.floor.kind);
      return { ...state, floor: isKnown ? state.floor : null };
    } catch {
      return null;
    }
  },
};
