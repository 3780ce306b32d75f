// The worker of the button "Make it faster": a robot in WebAssembly that can search for a faster gait.
import { expose } from 'comlink';

import { type FoundGait, initSync, Robot, type SearchTask, type Trial } from '../../generated/tune';
import { isRefused, type RobotOnFloor } from '../robot';

let robot: Robot;

/** A found gait, with its trial on the page's floor with the page's servos. */
export interface BestGait extends FoundGait {
  trial: Trial;
}

const api = {
  /**
   * Prepares a search. Returns the number of gaits to try, the speed that no servo may exceed, deg/s, and the trial of
   * the gait to beat. Throws an `Error` with the refusal as its message.
   */
  begin(module: WebAssembly.Module, { toml, floor, servos, task }: RobotOnFloor & { task: SearchTask }) {
    initSync({ module });
    robot = new Robot();
    robot.load(toml);
    robot.setFloor(floor);
    robot.setServoModel(servos);
    const extent = robot.beginSearch(task);
    if (isRefused(extent)) throw new Error(extent.reason);
    return { ...extent, referenceTrial: robot.tryGait(task.bars) as Trial };
  },

  /** Tries one more gait; returns the number of tried gaits and the best score. */
  tryNext: () => robot.tryNextGait(),

  /**
   * Compares the best gait so far with the gait to beat on `robotCount` random robots. Returns null until a tried
   * gait stays within the limits.
   */
  compareBest(robotCount: number): BestGait | null {
    const bestGait = robot.compareBestGait(robotCount);
    return bestGait && { ...bestGait, trial: robot.tryGait(bestGait.bars) as Trial };
  },
};

export type FasterWorkerApi = typeof api;
expose(api);
