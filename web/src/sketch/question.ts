// The question to the worker that checks other lengths while a joint is dragged, and its answer.
import type { Edits, Scene, TriedLengths } from '../robot';

export interface Question {
  toml: string;
  edits: Edits;
  /** True for the last question of a drag: if refused, what would do instead is searched. */
  isLast: boolean;
  /** The lengths whose range is wanted; none for no range. */
  keys: string[];
}

export interface Answer extends TriedLengths {
  edits: Edits;
  /** The neutral pose, if accepted. */
  scene: Scene | null;
  isLast: boolean;
  /** The least and the greatest value of the lengths whose range was asked for. */
  range: [number, number] | null;
}
