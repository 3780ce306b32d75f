// The session's state as signals, which views follow: each change calls the subscribers, and every `effect` that reads
// the signal.
import { signal } from '@preact/signals-core';

import type { Link } from './link/link';
import type { Banner, Description, Floor, Status } from './robot';

/** The firmware's pace after a reset, percent. */
export const FULL_PACE = 100;

/** A board's banner; `unknown` if this firmware answers but has sent no banner, null if it does not answer. */
export type BoardBanner = Banner | 'unknown' | null;

export class SessionState {
  /** The robot's description, which each change of the robot replaces; null before the first robot. */
  readonly description = signal<Description | null>(null);
  /** The floor set in the page; null for the floor of robot.toml. */
  readonly floor = signal<Floor | null>(null);
  /** The servo model: a name from the description, or such a name with a supply in V, as in `own at 4.2`. */
  readonly servos = signal('own');
  /** Supply voltage of the simulated board, V. */
  readonly volts = signal(5);
  readonly link = signal<Link | null>(null);
  /** The board's firmware and robot; undefined until known. */
  readonly banner = signal<BoardBanner | undefined>(undefined);
  /**
   * Number of received banners, and of restarts whose banner the link has lost. Each increment after the first banner
   * means a restart, which loses unsaved settings.
   */
  readonly bannerCount = signal(0);
  /** The robot's activity, a gait or a command; empty if it is unknown. */
  readonly gait = signal('');
  /** The robot's pace, percent. */
  readonly pace = signal(FULL_PACE);
  /** The robot's refusal of the last drive command; empty if the robot accepted the command. */
  readonly refusal = signal('');
  /** The board's last answer to `status`; null before its first answer. */
  readonly status = signal<Status | null>(null);
  /** True while a line has had no answer for `SILENCE_MS`, or a radio is out of range. */
  readonly isSilent = signal(false);
  /** True between the first `stop` and the robot's answer. */
  readonly isStopping = signal(false);
}
