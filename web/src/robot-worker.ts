// The worker that `startRobotWorker` starts. It has its own instance of the WebAssembly robot.
import { expose } from 'comlink';

import { type EditedGait, type Edits, type Four, isRefused, loadModule, type RobotOnFloor, Robot, type Scene } from './robot';

let robot: Robot;
/** The robot.toml of the loaded robot; empty before the first robot. */
let loadedToml = '';

/** Loads a robot, its floor and its servos; returns false if the robot is refused. */
function loadRobot({ toml, floor, servos }: RobotOnFloor): boolean {
  if (toml !== loadedToml) {
    if (isRefused(robot.load(toml))) return false;
    loadedToml = toml;
  }
  robot.setFloor(floor);
  robot.setServoModel(servos);
  return true;
}

/** Loads a robot and returns the scene of its neutral pose; null if the robot is refused. */
function loadNeutralScene(toml: string): Scene | null {
  const description = robot.load(toml);
  if (isRefused(description)) return null;
  loadedToml = toml;
  return robot.followPose(description.servos.map(({ neutral }) => neutral) as Four<number>, 1)?.scene ?? null;
}

const api = {
  /** Loads the WebAssembly module; must be called first. */
  load(module: WebAssembly.Module): void {
    robot = loadModule(module);
  },

  /** Predicts the gait with the index `gait`; returns null if the robot is refused. */
  predict: (request: RobotOnFloor & { gait: number }) => (loadRobot(request) ? robot.predict(request.gait) : null),

  /** Tries an edited gait; returns null if the robot is refused, or if a drawn line has no length. */
  tryGait: (request: RobotOnFloor & { gait: EditedGait }) => (loadRobot(request) ? robot.tryGait(request.gait) : null),

  /** Simulates the path of a routine's round; returns null if the robot is refused or has no such routine. */
  simulateRound: (request: RobotOnFloor & { routine: string }) => (loadRobot(request) ? robot.simulateRound(request.routine) : null),

  /**
   * Tries other lengths; if they are accepted, returns the scene of the neutral pose. `isLast` is true at the end of a
   * drag: only then does a refusal start a search for valid lengths. If `keys` is not empty, also returns the range of
   * the values that all lengths of these keys may have together.
   */
  tryLengths({ toml, edits, isLast, keys }: { toml: string; edits: Edits; isLast: boolean; keys: string[] }) {
    const result = Robot.tryLengths(toml, edits, isLast);
    const range = keys.length === 0 ? null : Robot.lengthRange(toml, keys);
    return { ...result, toml, edits, scene: result.refusal ? null : loadNeutralScene(result.text), isLast, range };
  },
};

export type RobotWorkerApi = typeof api;
expose(api);
