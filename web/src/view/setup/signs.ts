// The Signs step, in which the user checks each servo's direction of rotation. A servo with a wrong sign turns to the
// other side of its neutral angle; the guard would therefore accept an unsafe pose.
import { formatServo, SERVO_POSITIONS, type SelectedServo } from './drawing';
import { button, note, row, paragraph } from '../elements';
import type { Step, StepTools } from './step';

/** Returns the key that marks a servo's sign as checked. */
const toSignKey = (servo: number) => `sign ${servo}`;

/** Returns the servos whose signs have not been checked yet. */
export const findUncheckedServos = (tools: StepTools): number[] => [0, 1, 2, 3].filter((servo) => !tools.isDone(toSignKey(servo)));

export class SignsStep implements Step {
  readonly name = 'Signs';
  readonly title = 'Check the signs';
  readonly needsRobot = true;
  readonly isPerServo = true;
  /** The servo that was turned last and its rotation, deg counter-clockwise; null before the first rotation. */
  private lastTurn: { servo: number; turnDeg: number } | null = null;
  /** The fault that the user observed: another servo turned, or no servo turned; null if there is no fault. */
  private observedFault: 'other' | 'none' | null = null;

  reset(): void {
    this.lastTurn = this.observedFault = null;
  }

  selectedServo({ servo }: StepTools): SelectedServo {
    return { servo, turnDeg: this.lastTurn?.servo === servo ? this.lastTurn.turnDeg : 10 };
  }

  makeElements(tools: StepTools): Node[] {
    const { servo } = tools;
    const isTurned = this.lastTurn?.servo === servo;
    const name = `A${servo + 1}`;
    return [
      paragraph(`${formatServo(servo)}: only this servo turns, by 10°. Look from above.`),
      row(button(isTurned ? `Turn ${name} again` : `Turn ${name}`, () => this.turnServo(tools), !isTurned)),
      ...(isTurned ? this.makeQuestion(tools) : []),
      note('Do not skip this step: with a wrong sign, the robot would treat an unsafe pose as safe.'),
    ];
  }

  private makeQuestion(tools: StepTools): Node[] {
    const { servo, session } = tools;
    const { pin } = session.description.servos[servo];
    const observe = (observation: 'other' | 'none') => () => {
      this.observedFault = observation;
      tools.redraw();
    };
    const advice = {
      other: `Two signal wires are swapped. Switch off the servo supply and connect the signal of the ${SERVO_POSITIONS[servo]} servo to pin D${pin}. Then turn it again.`,
      none: `Check that its supply is on, that its ground is connected to the UNO's ground, and that its plug is the right way round, with the signal (orange) on pin D${pin}. Then turn it again.`,
    };
    return [
      paragraph('Did the servo turn in the direction of the arrow?'),
      row(
        button('Yes', () => this.markChecked(tools), true),
        button('No, in the other direction', () => this.reverseSign(tools)),
        button('Another servo turned', observe('other')),
        button('No servo turned', observe('none')),
      ),
      ...(this.observedFault ? [paragraph(advice[this.observedFault])] : []),
    ];
  }

  private turnServo({ servo, run }: StepTools): void {
    run(async (calibrator) => {
      const turnDeg = await calibrator.turnToCheckSign(servo);
      this.observedFault = null;
      this.lastTurn = { servo, turnDeg };
      return `A${servo + 1} received the command to turn by ${Math.abs(turnDeg)}° ${turnDeg > 0 ? 'counter-clockwise' : 'clockwise'}.`;
    });
  }

  private reverseSign({ servo, run }: StepTools): void {
    run(async (calibrator) => {
      await calibrator.reverseSign(servo);
      this.reset();
      return `The sign of A${servo + 1} is now "${calibrator.calibration.servos[servo].dir}". Turn it again and check.`;
    });
  }

  /** Marks this sign as checked and goes to the next unchecked servo, or to the next step. */
  private markChecked(tools: StepTools): void {
    tools.markDone(toSignKey(tools.servo));
    this.reset();
    const [nextServo] = findUncheckedServos(tools);
    if (nextServo !== undefined) {
      tools.servo = nextServo;
      return tools.redraw();
    }
    tools.markDone(this.name);
    tools.run(async (calibrator) => {
      await calibrator.stand();
      return 'All four servos turn in the right direction.';
    });
    tools.goTo('Trims');
  }
}
