// The question to the worker that checks other lengths while a joint is dragged, and its answer.
import type { Refused, Scene } from '../robot';

/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];

export interface Question {
  toml: string;
  edits: Edits;
  /** True for the last question of a drag: if refused, the nearest valid lengths are searched. */
  isLast: boolean;
}

export interface Answer {
  edits: Edits;
  /** The robot.toml with these lengths. */
  toml: string;
  /** The refusal, if any. */
  refused: Refused | null;
  /** The neutral pose, if accepted. */
  scene: Scene | null;
  /** The nearest valid lengths, if they were asked for and exist. */
  nearest: { edits: Edits; toml: string } | null;
  isLast: boolean;
}
