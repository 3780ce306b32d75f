// The step Signs, in which the user proves the direction in which each servo turns. A servo with a wrong sign stands
// on the other side of its neutral angle, and the guard would take an unsafe pose for a safe one.
import { nameOf, PLACES, type SelectedServo } from './drawing';
import { button, note, row, words } from '../make';
import type { Step, Tools } from './step';

const doneWord = (servo: number) => `sign ${servo}`;

/** The servos whose signs are not proven. */
export const unproven = (tools: Tools): number[] => [0, 1, 2, 3].filter((servo) => !tools.isDone(doneWord(servo)));

export class Signs implements Step {
  readonly name = 'Signs';
  readonly title = 'Prove the signs';
  readonly needsRobot = true;
  readonly isByServo = true;
  /** The servo that was turned, and its turn, deg; null before the first turn. */
  private moved: { servo: number; by: number } | null = null;
  /** The user's observation, if it points to a mistake in the wiring: another servo turned, or none. */
  private observed: 'other' | 'none' | null = null;

  forget(): void {
    this.moved = this.observed = null;
  }

  drawing({ servo }: Tools): SelectedServo {
    return { servo, by: this.moved?.servo === servo ? this.moved.by : 10 };
  }

  parts(tools: Tools): Node[] {
    const { servo } = tools;
    const wasMoved = this.moved?.servo === servo;
    const name = `A${servo + 1}`;
    return [
      words(`${nameOf(servo)}: one servo alone turns by 10°. Look from above.`),
      row(button(wasMoved ? `Turn ${name} once more` : `Turn ${name}`, () => this.turn(tools), !wasMoved)),
      ...(wasMoved ? this.question(tools) : []),
      note('Do not leave this step out: the robot would take an unsafe pose for a safe one.'),
    ];
  }

  private question(tools: Tools): Node[] {
    const { servo, session } = tools;
    const { pin } = session.description.servos[servo];
    const observe = (observation: 'other' | 'none') => () => {
      this.observed = observation;
      tools.show();
    };
    const advice = {
      other: `Two signal wires are exchanged. Switch the servos' supply off and put the signal of the servo at the ${PLACES[servo]} on pin D${pin}. Then turn it once more.`,
      none: `Has its supply power, and are its ground and the UNO's joined? Is its plug the right way round, the signal (orange) on pin D${pin}? Then turn it once more.`,
    };
    return [
      words('Did it turn as the arrow shows?'),
      row(
        button('Yes', () => this.markProven(tools), true),
        button('No, the other way', () => this.reverse(tools)),
        button('Another servo turned', observe('other')),
        button('Nothing turned', observe('none')),
      ),
      ...(this.observed ? [words(advice[this.observed])] : []),
    ];
  }

  private turn(tools: Tools): void {
    const { servo } = tools;
    tools.run(async (guide) => {
      const turn = await guide.turnForSign(servo);
      this.observed = null;
      this.moved = { servo, by: turn };
      return `A${servo + 1} was told to turn ${Math.abs(turn)}° ${turn > 0 ? 'counter-clockwise' : 'clockwise'}.`;
    });
  }

  private reverse(tools: Tools): void {
    const { servo } = tools;
    tools.run(async (guide) => {
      await guide.reverse(servo);
      this.forget();
      return `The sign of A${servo + 1} is "${guide.calibration.servos[servo].dir}" now. Turn it once more and look.`;
    });
  }

  /** Marks this sign as proven and goes to the next unproven servo, or to the next step. */
  private markProven(tools: Tools): void {
    tools.done(doneWord(tools.servo));
    this.forget();
    const [nextServo] = unproven(tools);
    if (nextServo !== undefined) {
      tools.servo = nextServo;
      return tools.show();
    }
    tools.done(this.name);
    tools.run(async (guide) => {
      await guide.stand();
      return 'All four turn the right way.';
    });
    tools.go('Trims');
  }
}
