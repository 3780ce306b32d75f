// The worker of RobotHelper: a robot in WebAssembly of its own.
import { expose } from 'comlink';

import { type EditedGait, type Edits, type Four, isRefused, load, type OnFloor, Robot, type Scene } from './robot';

let robot: Robot;
/** The robot.toml that was read last. */
let known = '';

/** Reads a robot; returns false if it is refused. */
function take({ toml, floor, servos }: OnFloor): boolean {
  if (toml !== known) {
    if (isRefused(robot.read(toml))) return false;
    known = toml;
  }
  robot.setFloor(floor);
  robot.setServos(servos);
  return true;
}

/** The neutral pose of a robot. */
function neutral(toml: string): Scene | null {
  const read = robot.read(toml);
  if (isRefused(read)) return null;
  known = toml;
  return robot.pose(read.servos.map(({ neutral }) => neutral) as Four<number>, 1)?.scene ?? null;
}

const functions = {
  load(module: WebAssembly.Module): void {
    robot = load(module);
  },

  predict: (of: OnFloor & { gait: number }) => (take(of) ? robot.predict(of.gait) : null),

  /** Tries an edited gait; null for a drawn line without length. */
  trial: (of: OnFloor & { made: EditedGait }) => (take(of) ? robot.trial(of.made) : null),

  /** The path of one round; null without the routine. */
  round: (of: OnFloor & { routine: string }) => (take(of) ? robot.round(of.routine) : null),

  /**
   * Tries other lengths, and draws the neutral pose if they are accepted. `isLast` is true for the end of a drag: if refused, what would
   * do instead is searched. The lengths of `keys`, if there are any, get their range.
   */
  lengths({ toml, edits, isLast, keys }: { toml: string; edits: Edits; isLast: boolean; keys: string[] }) {
    const tried = Robot.lengths(toml, edits, isLast);
    const range = keys.length === 0 ? null : Robot.lengthRange(toml, keys);
    return { ...tried, edits, scene: tried.refusal ? null : neutral(tried.text), isLast, range };
  },
};

export type RobotFunctions = typeof functions;
expose(functions);
