// What a worker is asked while a gait is made: where it would lead.
import type { Floor, Made, NoTrial, Trial } from '../robot';

export interface Question {
  toml: string;
  floor: Floor;
  servos: string;
  made: Made;
}

export interface Answer {
  made: Made;
  /** Null of a line without length. */
  trial: Trial | NoTrial | null;
}
