// Keeps the user's changes across a reload, in the browser's storage.
import type { Bars, Floor } from './robot';

/** A robot and the user's changes to it. */
export interface SavedChanges {
  /** The name of the robot's file. */
  file: string;
  /** The robot.toml of the file at that time: the changes apply only to this text. */
  original: string;
  /** The robot.toml with its changes. */
  toml: string;
  /** Floor, mass, feet and leg drive as set in the page; null for the values of robot.toml. */
  floor: Floor | null;
  servos: string;
  volts: number;
}

/** The prefix of the storage keys; it differs for pages at other addresses of the same server. */
const KEY = `lizard ${location.pathname}`;
const ASIDE_KEY = `${KEY} aside`;
const GAIT_KEY = `${KEY} gait`;

/** Largest number of robots that are put aside; older ones are dropped. */
const MAX_PUT_ASIDE = 8;

function store(key: string, value: unknown): void {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch (error) {
    console.info(`Changes are not kept over a reload: ${String(error)}`);
  }
}

/** Returns the stored robots that this version of the page can use; none if the text is damaged. */
function loadSavedChanges(key: string): SavedChanges[] {
  try {
    const states = [JSON.parse(localStorage.getItem(key) ?? '[]')].flat() as (SavedChanges | null)[];
    return states.flatMap((state) => {
      if (!state || typeof state.toml !== 'string' || typeof state.file !== 'string') return [];
      // An earlier page stored springs in another form, which is dropped.
      const isKnown = typeof state.floor?.twist === 'number' && ['rigid', 'strut'].includes(state.floor.kind);
      return [{ ...state, floor: isKnown ? state.floor : null }];
    });
  } catch {
    return [];
  }
}

/** True if a stored value has the fields of a gait; the ranges of its numbers are checked with the robot. */
function isGait(value: unknown): value is Bars {
  const { name, held, period, duty, amplitude, start, gain } = (value ?? {}) as Partial<Bars>;
  const numbers = [period, duty, amplitude, ...(start ?? []), ...(gain ?? [])];
  return typeof name === 'string' && typeof held === 'boolean' && numbers.length === 11 && numbers.every(Number.isFinite);
}

export const browserStorage = {
  /** Stores the changes; without storage in the browser they are lost at a reload. */
  putChanges: (state: SavedChanges) => store(KEY, state),

  /** Returns the stored changes; null if there are none that can be used. */
  getChanges: (): SavedChanges | null => loadSavedChanges(KEY)[0] ?? null,

  /** Returns the robots that were put aside, the latest first. */
  getPutAside: () => loadSavedChanges(ASIDE_KEY),

  putRobotsAside: (robots: SavedChanges[]) => store(ASIDE_KEY, robots.slice(0, MAX_PUT_ASIDE)),

  /** Returns the gait that is being made; null if there is none that can be used. */
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
