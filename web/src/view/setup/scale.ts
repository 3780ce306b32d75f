// The step Scale, in which the user measures how far each servo turns: not every servo turns by 1° per 10 µs of pulse
// width.
import { servoName, type SelectedServo } from './drawing';
import { button, note, numberBox, row, paragraph } from '../make';
import type { Step, StepTools } from './step';

export class ScaleStep implements Step {
  readonly name = 'Scale';
  readonly title = 'Measure how far they turn';
  readonly needsRobot = true;
  readonly isPerServo = true;
  /** The servo that was turned last, and its commanded turn, deg counter-clockwise; null before the turn. */
  private lastTurn: { servo: number; turnDeg: number } | null = null;

  reset(): void {
    this.lastTurn = null;
  }

  selectedServo({ servo }: StepTools): SelectedServo {
    return { servo, turnDeg: this.lastTurn?.servo === servo ? this.lastTurn.turnDeg : null };
  }

  makeElements(tools: StepTools): Node[] {
    const { guide, servo } = tools;
    const currentScale = guide?.calibration.servos[servo].scale;
    const isTurned = this.lastTurn?.servo === servo;
    return [
      paragraph(`Mark where the crank of ${servoName(servo)} points, turn it, and measure how far it went.`),
      row(button(`Turn A${servo + 1}`, () => this.turnServo(tools), !isTurned)),
      ...(isTurned ? [row(numberBox('It turned by, degrees', null, '0.1', (degrees) => this.setMeasuredTurn(tools, degrees)))] : []),
      paragraph(`Scale: ${currentScale === undefined ? '–' : `${currentScale.toFixed(2)} µs per degree`}`),
      note('Most servos are near 10. Without a protractor, leave this step out.'),
    ];
  }

  private turnServo({ servo, run }: StepTools): void {
    run(async (guide) => {
      const turn = await guide.turnForScale(servo);
      this.lastTurn = { servo, turnDeg: turn };
      return `A${servo + 1} was told to turn ${Math.abs(turn)}°. Measure it.`;
    });
  }

  private setMeasuredTurn({ servo, run, markDone }: StepTools, degrees: number): void {
    run(async (guide) => {
      if (!this.lastTurn || degrees <= 0) return 'Give how far it turned, in degrees, more than 0.';
      const commandedTurn = this.lastTurn.turnDeg;
      this.reset();
      const scale = await guide.scaleByTurn(servo, commandedTurn, degrees);
      markDone(this.name);
      return `The scale of A${servo + 1} is ${scale.toFixed(2)} µs per degree.`;
    });
  }
}
