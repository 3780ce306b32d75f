// The question to the worker that predicts the path of a routine, and its answer.
import type { Floor, RoundPath } from '../robot';

export interface Question {
  toml: string;
  floor: Floor;
  servos: string;
  /** Name of the routine. */
  routine: string;
}

/** The path of one round; null without the routine. */
export type Answer = RoundPath | null;
