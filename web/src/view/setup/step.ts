// The interface of a step of the first connection, and the tools that a step may use.
import type { Calibrator } from '../../../generated/board';
import type { BoardCalibrator } from '../../setup/board-calibrator';
import type { Session } from '../../session';
import type { WriteContent } from '../writer';
import type { SelectedServo } from './drawing';

/** The state and functions that the dialog offers to its steps. */
export interface StepTools {
  readonly session: Session;
  /** The calibrator for the connected robot; null until its calibration is read. */
  readonly calibrator: BoardCalibrator | null;
  /** The selected servo, 0 to 3. */
  servo: number;
  /** Connects a board on USB, or disconnects a board. */
  connect(): void;
  /** Writes the page's robot, alone or with the firmware. */
  write(content: WriteContent): void;
  /** Runs an action with the robot's calibrator; shows the returned message, or the error. */
  run(action: (calibrator: Calibrator) => Promise<string>): void;
  /** Makes the robot stand, with all servos at neutral. */
  stand(): void;
  /** Applies the calibration in the text of the file `name`, without saving it in the board. */
  setCalibration(text: string, name: string): void;
  /** Marks a step, or a part of a step, as done. */
  markDone(step: string): void;
  /** Returns true if a step, or a part of a step, is done. */
  isDone(step: string): boolean;
  goTo(step: string): void;
  redraw(): void;
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
  makeElements(tools: StepTools): Node[];
  /** Returns the highlighted servo of the drawing, null for none; a step without this method has no drawing. */
  selectedServo?(tools: StepTools): SelectedServo | null;
  /** Resets the step's state when the user enters the step or connects another board. */
  reset?(): void;
}
