// The Limits step, which limits each servo's travel, so that printed parts do not touch each other.
import { formatServo, type SelectedServo } from './drawing';
import { button, note, numberBox, row, paragraph } from '../elements';
import type { Step, StepTools } from './step';

/** Rotation of the servo per press of a button. */
const TURN_DEG = 5;

export class LimitsStep implements Step {
  readonly name = 'Limits';
  readonly title = 'Limit the servos’ travel';
  readonly needsRobot = true;
  readonly isPerServo = true;
  /** The servo that was turned last and its commanded angle, deg; null while the robot stands. */
  private lastTurn: { servo: number; degrees: number } | null = null;

  reset(): void {
    this.lastTurn = null;
  }

  selectedServo({ servo }: StepTools): SelectedServo {
    return { servo, turnDeg: null };
  }

  makeElements(tools: StepTools): Node[] {
    const { calibrator, servo, session } = tools;
    const limit = calibrator?.calibration.servos[servo].limit ?? null;
    const currentAngle = this.lastTurn?.servo === servo ? this.lastTurn.degrees : session.description.servos[servo].neutral;
    const [from, to] = limit ?? [0, 0];
    const makeBox = (label: string, value: number, action: (value: number) => void) => numberBox(label, value, '0.01', action);
    return [
      paragraph(`Turn ${formatServo(servo)} until a printed part is about to touch another part, and set the limit there. Skip this step if no parts touch.`),
      row(
        button(`↺ ${TURN_DEG}°`, () => this.turnServo(tools, currentAngle + TURN_DEG)),
        button(`↻ ${TURN_DEG}°`, () => this.turnServo(tools, currentAngle - TURN_DEG)),
        button('Stand', tools.stand),
      ),
      ...(limit
        ? [
            row(
              button('Set ↺ limit here', () => this.setLimit(tools, from, currentAngle)),
              button('Set ↻ limit here', () => this.setLimit(tools, currentAngle, to)),
            ),
            row(
              makeBox('From, degrees', from, (value) => this.setLimit(tools, value, to)),
              makeBox('to, degrees', to, (value) => this.setLimit(tools, from, value)),
            ),
          ]
        : []),
      note('The travel goes counter-clockwise from the first angle to the second angle. A limit that would make a gait impossible is refused.'),
    ];
  }

  private turnServo({ servo, run }: StepTools, degrees: number): void {
    run(async (calibrator) => {
      const angle = await calibrator.moveServo(servo, degrees);
      this.lastTurn = { servo, degrees };
      return `A${servo + 1} points to ${angle.toFixed(2)}°.`;
    });
  }

  private setLimit({ servo, run, markDone }: StepTools, from: number, to: number): void {
    run(async (calibrator) => {
      await calibrator.setLimit(servo, from, to);
      markDone(this.name);
      const [min, max] = calibrator.calibration.servos[servo].limit;
      return `A${servo + 1} travels from ${min.toFixed(2)}° to ${max.toFixed(2)}°.`;
    });
  }
}
