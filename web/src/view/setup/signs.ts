// The step Signs, in which the user proves the direction in which each servo turns. A servo with a wrong sign turns to
// the other side of its neutral angle, so the guard would accept an unsafe pose.
import { servoName, SERVO_PLACES, type SelectedServo } from './drawing';
import { button, note, row, paragraph } from '../make';
import type { Step, StepTools } from './step';

/** The key under which a servo's sign is marked as done. */
const signKey = (servo: number) => `sign ${servo}`;

/** Returns the servos whose signs are not proven yet. */
export const findUnprovenServos = (tools: StepTools): number[] => [0, 1, 2, 3].filter((servo) => !tools.isDone(signKey(servo)));

export class SignsStep implements Step {
  readonly name = 'Signs';
  readonly title = 'Prove the signs';
  readonly needsRobot = true;
  readonly isPerServo = true;
  /** The servo that was turned last, and its turn, deg counter-clockwise; null before the first turn. */
  private lastTurn: { servo: number; turnDeg: number } | null = null;
  /** The fault that the user has observed: another servo turned, or none; null without a fault. */
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
      paragraph(`${servoName(servo)}: one servo alone turns by 10°. Look from above.`),
      row(button(isTurned ? `Turn ${name} once more` : `Turn ${name}`, () => this.turnServo(tools), !isTurned)),
      ...(isTurned ? this.makeQuestion(tools) : []),
      note('Do not leave this step out: the robot would take an unsafe pose for a safe one.'),
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
      other: `Two signal wires are exchanged. Switch the servos' supply off and put the signal of the servo at the ${SERVO_PLACES[servo]} on pin D${pin}. Then turn it once more.`,
      none: `Has its supply power, and are its ground and the UNO's joined? Is its plug the right way round, the signal (orange) on pin D${pin}? Then turn it once more.`,
    };
    return [
      paragraph('Did it turn as the arrow shows?'),
      row(
        button('Yes', () => this.markProven(tools), true),
        button('No, the other way', () => this.reverseSign(tools)),
        button('Another servo turned', observe('other')),
        button('Nothing turned', observe('none')),
      ),
      ...(this.observedFault ? [paragraph(advice[this.observedFault])] : []),
    ];
  }

  private turnServo(tools: StepTools): void {
    const { servo } = tools;
    tools.run(async (guide) => {
      const turn = await guide.turnForSign(servo);
      this.observedFault = null;
      this.lastTurn = { servo, turnDeg: turn };
      return `A${servo + 1} was told to turn ${Math.abs(turn)}° ${turn > 0 ? 'counter-clockwise' : 'clockwise'}.`;
    });
  }

  private reverseSign(tools: StepTools): void {
    const { servo } = tools;
    tools.run(async (guide) => {
      await guide.reverse(servo);
      this.reset();
      return `The sign of A${servo + 1} is "${guide.calibration.servos[servo].dir}" now. Turn it once more and look.`;
    });
  }

  /** Marks this sign as proven and goes to the next unproven servo, or to the next step. */
  private markProven(tools: StepTools): void {
    tools.markDone(signKey(tools.servo));
    this.reset();
    const [nextServo] = findUnprovenServos(tools);
    if (nextServo !== undefined) {
      tools.servo = nextServo;
      return tools.redraw();
    }
    tools.markDone(this.name);
    tools.run(async (guide) => {
      await guide.stand();
      return 'All four turn the right way.';
    });
    tools.goTo('Trims');
  }
}
