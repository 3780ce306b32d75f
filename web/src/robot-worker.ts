// The worker that `robotHelper` starts. It has its own instance of the WebAssembly robot.
import { expose } from 'comlink';

import { type EditedGait, type Edits, type Four, isRefused, load, type OnFloor, Robot, type Scene } from './robot';

let robot: Robot;
/** The robot.toml of the robot that is loaded. */
let loadedToml = '';

/** Loads a robot, its floor and its servos; returns false if the robot is refused. */
function loadRobot({ toml, floor, servos }: OnFloor): boolean {
  if (toml !== loadedToml) {
    if (isRefused(robot.read(toml))) return false;
    loadedToml = toml;
  }
  robot.setFloor(floor);
  robot.setServos(servos);
  return true;
}

/** Loads a robot and returns the scene of its neutral pose; null if the robot is refused. */
function neutralScene(toml: string): Scene | null {
  const description = robot.read(toml);
  if (isRefused(description)) return null;
  loadedToml = toml;
  return robot.pose(description.servos.map(({ neutral }) => neutral) as Four<number>, 1)?.scene ?? null;
}

const functions = {
  /** Loads the WebAssembly module; must be called first. */
  load(module: WebAssembly.Module): void {
    robot = load(module);
  },

  /** Predicts a gait; null for a refused robot. */
  predict: (request: OnFloor & { gait: number }) => (loadRobot(request) ? robot.predict(request.gait) : null),

  /** Tries an edited gait; null for a refused robot or a drawn line without length. */
  trial: (request: OnFloor & { gait: EditedGait }) => (loadRobot(request) ? robot.trial(request.gait) : null),

  /** Returns the path of one round of a routine; null if the robot is refused or has no such routine. */
  round: (request: OnFloor & { routine: string }) => (loadRobot(request) ? robot.round(request.routine) : null),

  /**
   * Tries other lengths, and draws the neutral pose if they are accepted. `isLast` is true at the end of a drag: if
   * the lengths are refused then, it searches for lengths that would be accepted. If `keys` is not empty, it also
   * returns the range of values that all lengths of these keys may have together.
   */
  lengths({ toml, edits, isLast, keys }: { toml: string; edits: Edits; isLast: boolean; keys: string[] }) {
    const result = Robot.lengths(toml, edits, isLast);
    const range = keys.length === 0 ? null : Robot.lengthRange(toml, keys);
    return { ...result, edits, scene: result.refusal ? null : neutralScene(result.text), isLast, range };
  },
};

export type RobotFunctions = typeof functions;
expose(functions);
