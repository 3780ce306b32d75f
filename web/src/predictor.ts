// Predicts each gait's displacement in a worker, because a prediction takes seconds on a phone. The page's own robots
// have files with their predictions.
import { signal } from '@preact/signals-core';

import { follow } from './follow';
import type { CallableWorker } from './callable-worker';
import type { GaitPrediction } from './robot';
import { reportWorkerFailure, startRobotWorker } from './robot-requests';
import type { RobotWorkerApi } from './robot-worker';
import type { Session } from './session';

/** A gait and its predicted displacement per cycle. */
export interface PredictedGait {
  command: string;
  displacement: GaitPrediction;
}

export class Predictor {
  /** The predictions so far for the session's robot, by the gaits' commands. */
  readonly predictions = signal<ReadonlyMap<string, GaitPrediction>>(new Map());
  private worker: Promise<CallableWorker<RobotWorkerApi>> | null = null;
  /** Number of calls of `predict` so far; a later call cancels an earlier call. */
  private callCount = 0;

  constructor(private readonly session: Session) {
    session.robot.follow(() => (this.predictions.value = new Map()));
    const { description, floor, servos } = session.state;
    follow([description, floor, servos], () => description.value && void this.predict().catch(reportWorkerFailure));
  }

  /** The gaits with a prediction, in the robot's order. */
  get gaits(): PredictedGait[] {
    return this.session.robot.description.gaits.flatMap(({ command }) => {
      const displacement = this.predictions.value.get(command);
      return displacement ? [{ command, displacement }] : [];
    });
  }

  /** Predicts every gait, starting with the robot's current gait; a later call cancels this call. */
  private async predict(): Promise<void> {
    const { toml, floor, servos, description, filePredictions } = this.session.robot;
    const { gait: currentGait } = this.session.board;
    const { gaits } = description;
    const callNumber = ++this.callCount;
    filePredictions?.forEach((prediction, gait) => this.put(gaits[gait].command, prediction));
    if (filePredictions) return;
    const firstIndex = Math.max(0, gaits.findIndex(({ command }) => command === currentGait));
    for (let n = 0; n < gaits.length; n++) {
      const gait = (firstIndex + n) % gaits.length;
      const prediction = await (await (this.worker ??= startRobotWorker())).call((robot) => robot.predict({ toml, floor, servos, gait }));
      if (callNumber !== this.callCount) return;
      this.put(gaits[gait].command, prediction);
    }
  }

  private put(command: string, prediction: GaitPrediction | null): void {
    if (prediction) this.predictions.value = new Map(this.predictions.value).set(command, prediction);
  }
}
