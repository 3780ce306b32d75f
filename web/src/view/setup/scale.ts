// The Scale step, in which the user measures each servo's rotation: not every servo turns by 1° per 10 µs of pulse
// width.
import { formatServo, type SelectedServo } from './drawing';
import { button, note, numberBox, row, paragraph } from '../elements';
import type { Step, StepTools } from './step';

export class ScaleStep implements Step {
  readonly name = 'Scale';
  readonly title = 'Measure the servos’ rotation';
  readonly needsRobot = true;
  readonly isPerServo = true;
  /** The servo that was turned last and its commanded rotation, deg counter-clockwise; null before the rotation. */
  private lastTurn: { servo: number; turnDeg: number } | null = null;

  reset(): void {
    this.lastTurn = null;
  }

  selectedServo({ servo }: StepTools): SelectedServo {
    return { servo, turnDeg: this.lastTurn?.servo === servo ? this.lastTurn.turnDeg : null };
  }

  makeElements(tools: StepTools): Node[] {
    const { calibrator, servo } = tools;
    const currentScale = calibrator?.calibration.servos[servo].scale;
    const isTurned = this.lastTurn?.servo === servo;
    return [
      paragraph(`Mark the direction of the crank of ${formatServo(servo)}, turn the servo, and measure the angle.`),
      row(button(`Turn A${servo + 1}`, () => this.turnServo(tools), !isTurned)),
      ...(isTurned ? [row(numberBox('Measured angle, degrees', null, '0.1', (degrees) => this.setMeasuredTurn(tools, degrees)))] : []),
      paragraph(`Scale: ${currentScale === undefined ? '–' : `${currentScale.toFixed(2)} µs per degree`}`),
      note('Most servos have about 10 µs per degree. Without a protractor, skip this step.'),
    ];
  }

  private turnServo({ servo, run }: StepTools): void {
    run(async (calibrator) => {
      const turnDeg = await calibrator.turnToMeasureScale(servo);
      this.lastTurn = { servo, turnDeg };
      return `A${servo + 1} received the command to turn by ${Math.abs(turnDeg)}°. Measure its angle.`;
    });
  }

  private setMeasuredTurn({ servo, run, markDone }: StepTools, degrees: number): void {
    run(async (calibrator) => {
      if (!this.lastTurn || degrees <= 0) return 'The measured angle must be more than 0 degrees.';
      const commandedTurn = this.lastTurn.turnDeg;
      this.reset();
      const scale = await calibrator.setScaleFromTurn(servo, commandedTurn, degrees);
      markDone(this.name);
      return `The scale of A${servo + 1} is ${scale.toFixed(2)} µs per degree.`;
    });
  }
}
