// What a worker is asked while a joint is dragged: what the robot becomes with other lengths.
import type { Refused, Scene } from '../robot';

/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];

export interface Question {
  toml: string;
  edits: Edits;
  /** Whether the nearest that would do is looked for, where this will not. */
  isLast: boolean;
}

export interface Answer {
  edits: Edits;
  /** The robot.toml with them. */
  toml: string;
  /** Why it will not do. */
  refused: Refused | null;
  /** Its neutral pose, if it will. */
  scene: Scene | null;
  /** The nearest on the way to it that will do, where that was asked for and is any. */
  nearest: { edits: Edits; toml: string } | null;
  isLast: boolean;
}
