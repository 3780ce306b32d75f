// The worker of FasterSearch: a robot in WebAssembly with the search for a faster gait.
import { expose } from 'comlink';

import { type Found, initSync, Robot, type SearchTask, type Trial } from '../../generated/tune';
import { isRefused, type OnFloor } from '../robot';

let robot: Robot;

/** A gait that the search has found, with its trial on the page's floor with the page's servos. */
export interface BestGait extends Found {
  trial: Trial;
}

const api = {
  /**
   * Prepares a search. Returns the number of gaits to try, the speed that no servo may exceed, deg/s, and the trial of
   * the gait to beat. Throws an `Error` whose message is the refusal.
   */
  begin(module: WebAssembly.Module, { toml, floor, servos, task }: OnFloor & { task: SearchTask }) {
    initSync({ module });
    robot = new Robot();
    robot.read(toml);
    robot.setFloor(floor);
    robot.setServos(servos);
    const search = robot.makeFaster(task);
    if (isRefused(search)) throw new Error(search.refused);
    return { ...search, referenceTrial: robot.trial(task.bars) as Trial };
  },

  /** Tries one more gait; returns the number of gaits tried so far, and the best score. */
  tryNext: () => robot.fasterStep(),

  /**
   * Returns the best gait so far, compared with the gait to beat on `robotCount` random robots; null until a gait stays
   * within the limits.
   */
  bestSoFar(robotCount: number): BestGait | null {
    const bestGait = robot.fasterFound(robotCount);
    return bestGait && { ...bestGait, trial: robot.trial(bestGait.bars) as Trial };
  },
};

export type FasterWorkerApi = typeof api;
expose(api);
