// Keeps the user's changes in the browser's local storage, so that they survive a reload.
import type { Bars, Floor } from './robot';

/** A robot and the user's changes to it. */
export interface SavedChanges {
  /** The name of the robot's file. */
  file: string;
  /** The file's robot.toml at the time of the changes, which apply only to this text. */
  original: string;
  /** The changed robot.toml. */
  toml: string;
  /** Floor, mass, feet and leg drive set in the page; null for the values of robot.toml. */
  floor: Floor | null;
  /** The servo model, as in `SessionState.servos`. */
  servos: string;
  /** Supply voltage of the simulated board, V. */
  volts: number;
}

/** The key of the changes, and the prefix of all keys. It differs between pages of the same server. */
const CHANGES_KEY = `lizard ${location.pathname}`;
const ASIDE_KEY = `${CHANGES_KEY} aside`;
const GAIT_KEY = `${CHANGES_KEY} gait`;

/** Largest number of robots put aside; older robots are dropped. */
const MAX_ROBOTS_ASIDE = 8;

/** The values that the browser did not store, as JSON; they last until the page is closed. */
const unstoredValues = new Map<string, string>();

function store(key: string, value: unknown): void {
  const json = JSON.stringify(value);
  unstoredValues.delete(key);
  try {
    localStorage.setItem(key, json);
  } catch (error) {
    unstoredValues.set(key, json);
    console.info(`Changes will not survive a reload: ${String(error)}`);
  }
}

/** Loads a stored value; returns null if it is missing or damaged. */
function load(key: string): unknown {
  try {
    return JSON.parse(unstoredValues.get(key) ?? localStorage.getItem(key) ?? 'null');
  } catch {
    return null;
  }
}

/** Loads the stored robots that this version of the page can use. */
function loadSavedChanges(key: string): SavedChanges[] {
  const robots = [load(key)].flat() as (SavedChanges | null)[];
  return robots.flatMap((robot) => {
    if (!robot || typeof robot.toml !== 'string' || typeof robot.file !== 'string') return [];
    // An earlier version of the page stored springs in another format, which is dropped.
    const isCurrentFormat = typeof robot.floor?.twist === 'number' && ['rigid', 'strut'].includes(robot.floor.kind);
    return [{ ...robot, floor: isCurrentFormat ? robot.floor : null }];
  });
}

/** Returns true if a stored value has the fields of a gait; the robot checks the ranges of the numbers later. */
function isGait(value: unknown): value is Bars {
  const { name, held, period, duty, amplitude, start, gain } = (value ?? {}) as Partial<Bars>;
  const numbers = [period, duty, amplitude, start, gain].flat();
  return typeof name === 'string' && typeof held === 'boolean' && numbers.length === 11 && numbers.every(Number.isFinite);
}

export const browserStorage = {
  /** Stores the changes; without storage in the browser, a reload loses them. */
  putChanges: (changes: SavedChanges) => store(CHANGES_KEY, changes),

  /** Returns the stored changes; null if no usable changes are stored. */
  getChanges: (): SavedChanges | null => loadSavedChanges(CHANGES_KEY)[0] ?? null,

  /** Returns the robots put aside, the latest first. */
  getRobotsAside: () => loadSavedChanges(ASIDE_KEY),

  putRobotsAside: (robots: SavedChanges[]) => store(ASIDE_KEY, robots.slice(0, MAX_ROBOTS_ASIDE)),

  /** Returns the gait in the editor; null if no usable gait is stored. */
  getGait: (): Bars | null => {
    const gait = load(GAIT_KEY);
    return isGait(gait) ? gait : null;
  },

  putGait: (gait: Bars) => store(GAIT_KEY, gait),
};
