// A step of the first connection, and what it may use.
import type { Guide } from '../../setup/guide';
import type { Session } from '../../session';
import type { What, Writer } from '../writer';
import type { Shown } from './drawing';

export interface Tools {
  readonly session: Session;
  readonly writer: Writer;
  /** What the robot has; null before it has said that. */
  readonly guide: Guide | null;
  /** The servo that a step is about, 0 to 3. */
  servo: number;
  /** Takes or leaves a board on USB. */
  connect(): void;
  /** Writes the page's robot, alone or with the firmware. */
  write(what: What): void;
  /** Does something at the robot; what is returned is said, and so is why it was not done. */
  run(act: (guide: Guide) => Promise<string>): void;
  /** Gives the robot the calibration of a file, unsaved. */
  give(text: string, name: string): void;
  /** Says that this step is done. */
  done(step: string): void;
  /** Whether it was. */
  isDone(step: string): boolean;
  /** To another step. */
  go(step: string): void;
  /** Shows the step anew. */
  show(): void;
}

export interface Step {
  /** Its name in the list of steps. */
  readonly name: string;
  readonly title: string;
  /** Whether a robot with this firmware has to answer. */
  readonly needsRobot: boolean;
  /** Whether it goes from servo to servo. */
  readonly isByServo?: boolean;
  /** What a person sees and may do. */
  parts(tools: Tools): Node[];
  /** What the drawing shows; without it there is none. */
  drawing?(tools: Tools): Shown | null;
  /** Begins anew, for another board or after it was left. */
  forget?(): void;
}
