// The interface of a step of the first connection.
import type { SetupDialog } from '../setup';
import type { Highlight } from './drawing';

/** The last turn of a servo in a step. */
export interface Turn {
  step: Step;
  servo: number;
  /** The commanded rotation, deg counter-clockwise; in the step Limits, the commanded angle. */
  commandedDegrees: number;
  /** The fault that the user observed in the step Signs: another servo turned, or no servo turned. */
  fault?: 'otherServo' | 'noServo';
}

/** A step of the first connection. */
export interface Step {
  /** The step's name in the list of steps. */
  readonly name: string;
  readonly title: string;
  /** True if the step needs a robot with this firmware. */
  readonly needsRobot: boolean;
  /** True if the step concerns one servo at a time, which the user selects. */
  readonly isPerServo?: boolean;
  makeElements(dialog: SetupDialog): Node[];
  /** Returns what the drawing highlights, null for nothing; a step without this method has no drawing. */
  highlight?(dialog: SetupDialog): Highlight | null;
}
