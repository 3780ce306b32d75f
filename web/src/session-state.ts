// The state of the session that views follow, as signals: whoever reads one in an `effect`, or subscribes to it, learns of
// each change.
import { signal } from '@preact/signals-core';

import type { Link } from './link/link';
import type { Banner, Description, Floor, Status } from './robot';

/** The firmware's pace after a reset, percent. */
export const FULL_PACE = 100;

/** A board's banner; `unknown` if this firmware answers but sent no banner, null if it does not answer. */
export type BoardBanner = Banner | 'unknown' | null;

export class SessionState {
  /** The robot; a new object also for the same robot with other values. Null before the first. */
  readonly description = signal<Description | null>(null);
  /** The floor as set in the page; null for that of robot.toml. */
  readonly floor = signal<Floor | null>(null);
  /** The servo model, by its name in the description. */
  readonly servos = signal('own');
  readonly link = signal<Link | null>(null);
  /** The board's firmware and robot; undefined until known. */
  readonly banner = signal<BoardBanner | undefined>(undefined);
  /** Number of banners received: a board that restarts has lost its unsaved settings. */
  readonly bannerCount = signal(0);
  /** The robot's activity: a gait or a command; empty if unknown. */
  readonly gait = signal('');
  /** The robot's pace, percent. */
  readonly pace = signal(FULL_PACE);
  /** The refusal of the last line that drives the robot, for the user; empty if it was accepted. */
  readonly refusal = signal('');
  /** The last answer to `status`; null before the first. */
  readonly status = signal<Status | null>(null);
  /** True while the robot leaves a line unanswered. */
  readonly isSilent = signal(false);
  /** True from the first `stop` until the robot has answered it. */
  readonly isStopping = signal(false);
}
