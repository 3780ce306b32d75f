// Predicts each gait's displacement in a worker: on a phone this takes seconds. The predictions for the robots that
// come with the page are files of the page.
import { signal } from '@preact/signals-core';

import { follow } from './follow';
import type { Helper } from './helper';
import type { GaitPrediction } from './robot';
import { robotHelper } from './robot-helper';
import type { RobotFunctions } from './robot-worker';
import type { Session } from './session';

/** A gait and its predicted displacement per cycle. */
export interface PredictedGait {
  command: string;
  displacement: GaitPrediction;
}

export class Predictor {
  /** The predictions for the session's robot so far, by the gaits' commands. */
  readonly predictions = signal<ReadonlyMap<string, GaitPrediction>>(new Map());
  private helper: Promise<Helper<RobotFunctions>> | null = null;
  private questionCount = 0;

  constructor(private readonly session: Session) {
    session.followRobot(() => (this.predictions.value = new Map()));
    const { description, floor, servos } = session.state;
    follow([description, floor, servos], () => description.value && void this.predict());
  }

  /** The gaits that have a prediction, in the robot's order. */
  get gaits(): PredictedGait[] {
    return this.session.description.gaits.flatMap(({ command }) => {
      const displacement = this.predictions.value.get(command);
      return displacement ? [{ command, displacement }] : [];
    });
  }

  /** Predicts every gait, beginning with the robot's current one; a newer call ends it. */
  private async predict(): Promise<void> {
    const { toml, floor, servos, description, filePredictions, gait: currentGait } = this.session;
    const { gaits } = description;
    const questionNumber = ++this.questionCount;
    filePredictions?.forEach((prediction, gait) => this.put(gaits[gait].command, prediction));
    if (filePredictions) return;
    const firstIndex = Math.max(0, gaits.findIndex(({ command }) => command === currentGait));
    for (let n = 0; n < gaits.length; n++) {
      const gait = (firstIndex + n) % gaits.length;
      const prediction = await (await (this.helper ??= robotHelper())).ask((robot) => robot.predict({ toml, floor, servos, gait }));
      if (questionNumber !== this.questionCount) return;
      this.put(gaits[gait].command, prediction);
    }
  }

  private put(command: string, prediction: GaitPrediction | null): void {
    if (prediction) this.predictions.value = new Map(this.predictions.value).set(command, prediction);
  }
}
