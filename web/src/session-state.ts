// The state of the session that views follow, as signals: an `effect` that reads a signal, or a subscriber, is called
// at each change.
import { signal } from '@preact/signals-core';

import type { Link } from './link/link';
import type { Banner, Description, Floor, Status } from './robot';

/** The firmware's pace after a reset, percent. */
export const FULL_PACE = 100;

/** A board's banner; `unknown` if this firmware answers but sent no banner, null if it does not answer. */
export type BoardBanner = Banner | 'unknown' | null;

export class SessionState {
  /** The robot's description, replaced at each change of the robot; null before the first robot. */
  readonly description = signal<Description | null>(null);
  /** The floor as set in the page; null if it is that of robot.toml. */
  readonly floor = signal<Floor | null>(null);
  /** The servo model, by its name in the description. */
  readonly servos = signal('own');
  readonly link = signal<Link | null>(null);
  /** The board's firmware and robot; undefined until known. */
  readonly banner = signal<BoardBanner | undefined>(undefined);
  /** Number of banners received; each one after the first tells of a restart, which loses unsaved settings. */
  readonly bannerCount = signal(0);
  /** The robot's activity, a gait or a command; empty if unknown. */
  readonly gait = signal('');
  /** The robot's pace, percent. */
  readonly pace = signal(FULL_PACE);
  /** The message with which the robot refused the last drive command; empty if it was accepted. */
  readonly refusal = signal('');
  /** The last answer to `status`; null before the first. */
  readonly status = signal<Status | null>(null);
  /** True while a line has been without an answer for `SILENCE_MS`, or a radio is out of range. */
  readonly isSilent = signal(false);
  /** True from the first `stop` until the robot has answered it. */
  readonly isStopping = signal(false);
}
