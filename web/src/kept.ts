// What a person has changed, over a reload: the browser keeps it for the page's address.
import type { Floor } from './robot';

/** A robot with what was changed of it. */
export interface Kept {
  /** The name of its file. */
  file: string;
  /** The robot.toml of the file as it was then: the changes belong to this one alone. */
  original: string;
  /** The robot.toml with its changes. */
  toml: string;
  /** What the page has set of floor, weight, feet and drive; null for what robot.toml says. */
  floor: Floor | null;
  servos: string;
  volts: number;
}

/** Pages of another address on the same server have their own. */
const KEY = `lizard ${location.pathname}`;

export const kept = {
  /** Keeps it; a browser that keeps nothing for a page loses it with a reload. */
  put(state: Kept): void {
    try {
      localStorage.setItem(KEY, JSON.stringify(state));
    } catch (error) {
      console.info(`Changes are not kept over a reload: ${String(error)}`);
    }
  },

  /** What was kept; null where there is nothing of use. */
  get(): Kept | null {
    try {
      const state = JSON.parse(localStorage.getItem(KEY) ?? 'null') as Kept | null;
      if (!state || typeof state.toml !== 'string' || typeof state.file !== 'string') return null;
      // An earlier page kept springs in another form: what it had set is let go.
      return { ...state, floor: state.floor && typeof state.floor.twist === 'number' ? state.floor : null };
    } catch {
      return null;
    }
  },
};
