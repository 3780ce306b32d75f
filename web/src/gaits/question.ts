// The question to the worker that predicts an edited gait, and its answer.
import type { Floor, Made, NoTrial, Trial } from '../robot';

export interface Question {
  toml: string;
  floor: Floor;
  servos: string;
  made: Made;
}

export interface Answer {
  made: Made;
  /** Null if the drawn line has no length. */
  trial: Trial | NoTrial | null;
}
