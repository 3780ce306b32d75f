// The step Scale: measures how far each servo turns, since not every servo turns 1 deg per 10 us of pulse width.
import { nameOf, type SelectedServo } from './drawing';
import { button, note, number, row, words } from '../make';
import type { Step, Tools } from './step';

export class Scale implements Step {
  readonly name = 'Scale';
  readonly title = 'Measure how far they turn';
  readonly needsRobot = true;
  readonly isByServo = true;
  /** The servo that was turned, and its commanded turn, deg; null before the turn. */
  private turned: { servo: number; by: number } | null = null;

  forget(): void {
    this.turned = null;
  }

  drawing({ servo }: Tools): SelectedServo {
    return { servo, by: this.turned?.servo === servo ? this.turned.by : null };
  }

  parts(tools: Tools): Node[] {
    const { guide, servo } = tools;
    const currentScale = guide?.calibration.servos[servo].scale;
    const isTurned = this.turned?.servo === servo;
    return [
      words(`Mark where the crank of ${nameOf(servo)} points, turn it, and measure how far it went.`),
      row(button(`Turn A${servo + 1}`, () => this.turn(tools), !isTurned)),
      ...(isTurned ? [row(number('It turned by, degrees', null, '0.1', (degrees) => this.setMeasuredTurn(tools, degrees)))] : []),
      words(`Scale: ${currentScale === undefined ? '–' : `${currentScale.toFixed(2)} µs per degree`}`),
      note('Most servos are near 10. Without a protractor, leave this step out.'),
    ];
  }

  private turn({ servo, run }: Tools): void {
    run(async (guide) => {
      const turn = await guide.turnForScale(servo);
      this.turned = { servo, by: turn };
      return `A${servo + 1} was told to turn ${Math.abs(turn)}°. Measure it.`;
    });
  }

  private setMeasuredTurn({ servo, run, done }: Tools, degrees: number): void {
    run(async (guide) => {
      if (!this.turned || degrees <= 0) return 'Give how far it turned, in degrees, more than 0.';
      const askedTurn = this.turned.by;
      this.forget();
      const scale = await guide.scaleByTurn(servo, askedTurn, degrees);
      done(this.name);
      return `The scale of A${servo + 1} is ${scale.toFixed(2)} µs per degree.`;
    });
  }
}
