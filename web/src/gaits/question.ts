// The question to the worker that predicts an edited gait, and its answer.
import type { Floor, EditedGait, NoTrial, Trial } from '../robot';

export interface Question {
  toml: string;
  floor: Floor;
  servos: string;
  made: EditedGait;
}

export interface Answer {
  made: EditedGait;
  /** Null if the drawn line has no length. */
  trial: Trial | NoTrial | null;
}
