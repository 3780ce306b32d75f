// Keeps the user's changes in the browser's local storage, so that they survive a reload.
import type { Bars, Floor } from './robot';

/** A robot and the user's changes to it. */
export interface SavedChanges {
  /** The name of the robot's file. */
  file: string;
  /** The robot.toml of the file when the changes were made: they apply only to this text. */
  original: string;
  /** The changed robot.toml. */
  toml: string;
  /** Floor, mass, feet and leg drive as set in the page; null for the values of robot.toml. */
  floor: Floor | null;
  servos: string;
  volts: number;
}

/** The key of the changes and the prefix of all keys; it differs between pages of the same server. */
const CHANGES_KEY = `lizard ${location.pathname}`;
const ASIDE_KEY = `${CHANGES_KEY} aside`;
const GAIT_KEY = `${CHANGES_KEY} gait`;

/** Largest number of robots that are put aside; the oldest ones beyond it are dropped. */
const MAX_PUT_ASIDE = 8;

function store(key: string, value: unknown): void {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch (error) {
    console.info(`Changes are not kept over a reload: ${String(error)}`);
  }
}

/** Returns the stored robots that this version of the page can use; an empty list if the stored text is damaged. */
function loadSavedChanges(key: string): SavedChanges[] {
  try {
    const states = [JSON.parse(localStorage.getItem(key) ?? '[]')].flat() as (SavedChanges | null)[];
    return states.flatMap((state) => {
      if (!state || typeof state.toml !== 'string' || typeof state.file !== 'string') return [];
      // An earlier version of the page stored springs in another form, which is dropped.
      const isCurrentForm = typeof state.floor?.twist === 'number' && ['rigid', 'strut'].includes(state.floor.kind);
      return [{ ...state, floor: isCurrentForm ? state.floor : null }];
    });
  } catch {
    return [];
  }
}

/** True if a stored value has the fields of a gait; the ranges of its numbers are checked later, with the robot. */
function isGait(value: unknown): value is Bars {
  const { name, held, period, duty, amplitude, start, gain } = (value ?? {}) as Partial<Bars>;
  const numbers = [period, duty, amplitude, ...(start ?? []), ...(gain ?? [])];
  return typeof name === 'string' && typeof held === 'boolean' && numbers.length === 11 && numbers.every(Number.isFinite);
}

export const browserStorage = {
  /** Stores the changes; if the browser has no storage, they are lost at a reload. */
  putChanges: (state: SavedChanges) => store(CHANGES_KEY, state),

  /** Returns the stored changes; null if there are no usable ones. */
  getChanges: (): SavedChanges | null => loadSavedChanges(CHANGES_KEY)[0] ?? null,

  /** Returns the robots that were put aside, the latest first. */
  getPutAside: () => loadSavedChanges(ASIDE_KEY),

  putRobotsAside: (robots: SavedChanges[]) => store(ASIDE_KEY, robots.slice(0, MAX_PUT_ASIDE)),

  /** Returns the gait in the editor; null if there is no usable one. */
  getGait: (): Bars | null => {
    try {
      const gait: unknown = JSON.parse(localStorage.getItem(GAIT_KEY) ?? 'null');
      return isGait(gait) ? gait : null;
    } catch {
      return null;
    }
  },

  putGait: (gait: Bars) => store(GAIT_KEY, gait),
};
