// Predicts each gait's displacement in a worker: on a phone this takes seconds. The predictions for the robots that
// come with the page are files of the page.
import type { Helper } from './helper';
import type { GaitPrediction, OnFloor } from './robot';
import { robotHelper } from './robot-helper';
import type { RobotFunctions } from './robot-worker';

export class Predictor {
  private helper: Helper<RobotFunctions> | null = null;
  private questionCount = 0;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly onPrediction: (gait: number, prediction: GaitPrediction) => void,
  ) {}

  /** Predicts every gait of a robot, beginning with the gait `first`; a newer call ends it. */
  async ask({ gaits: gaitCount, first: firstGait, ...robotOnFloor }: OnFloor & { gaits: number; first: number }): Promise<void> {
    const questionNumber = ++this.questionCount;
    for (let n = 0; n < gaitCount; n++) {
      const gait = (firstGait + n) % gaitCount;
      this.helper ??= robotHelper(this.module);
      const prediction = await this.helper.ask((robot) => robot.predict({ ...robotOnFloor, gait }));
      if (questionNumber !== this.questionCount) return;
      if (prediction) this.onPrediction(gait, prediction);
    }
  }
}
