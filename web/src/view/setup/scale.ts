// The Scale step, in which the user measures each servo's rotation: not every servo turns by 1° per 10 µs of pulse
// width.
import type { SetupDialog } from '../setup';
import { formatServo } from './drawing';
import { button, note, numberBox, row, paragraph } from '../elements';
import type { Step, Turn } from './step';

export const scaleStep: Step = {
  name: 'Scale',
  title: 'Measure the servos’ rotation',
  needsRobot: true,
  isPerServo: true,
  highlight: ({ servo, currentTurn }) => ({ servo, turnDeg: currentTurn?.commandedDegrees ?? null }),
  makeElements(dialog) {
    const { calibrator, servo, currentTurn } = dialog;
    const currentScale = calibrator?.calibration.servos[servo].scale;
    return [
      paragraph(`Mark the direction of the crank of ${formatServo(servo)}, turn the servo, and measure the angle by which it turns.`),
      row(button(`Turn A${servo + 1}`, () => turnServo(dialog), !currentTurn)),
      ...(currentTurn ? [row(numberBox('Measured angle, degrees', null, '0.1', (measuredDegrees) => setScale(dialog, currentTurn, measuredDegrees)))] : []),
      paragraph(`Scale: ${currentScale === undefined ? '–' : `${currentScale.toFixed(2)} µs per degree`}`),
      note('Most servos have about 10 µs per degree. Without a protractor, skip this step.'),
    ];
  },
};

function turnServo(dialog: SetupDialog): void {
  const { servo, run } = dialog;
  run(async (calibrator) => {
    const commandedDegrees = await calibrator.turnToMeasureScale(servo);
    dialog.lastTurn = { step: scaleStep, servo, commandedDegrees };
    return `A${servo + 1} received the command to turn by ${Math.abs(commandedDegrees)}°. Measure the angle by which it turned.`;
  });
}

function setScale(dialog: SetupDialog, { servo, commandedDegrees }: Turn, measuredDegrees: number): void {
  dialog.run(async (calibrator) => {
    if (measuredDegrees <= 0) return 'The measured angle must be more than 0 degrees.';
    dialog.lastTurn = null;
    const scale = await calibrator.setScaleFromTurn(servo, commandedDegrees, measuredDegrees);
    dialog.markDone('Scale');
    return `The scale of A${servo + 1} is ${scale.toFixed(2)} µs per degree.`;
  });
}
