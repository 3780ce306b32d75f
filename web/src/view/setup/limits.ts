// The Limits step, which limits each servo's travel, so that printed parts do not touch each other.
import type { SetupDialog } from '../setup';
import { formatServo } from './drawing';
import { button, note, numberBox, row, paragraph } from '../elements';
import type { Step } from './step';

/** Rotation of the servo per press of a button. */
const TURN_DEG = 5;

export const limitsStep: Step = {
  name: 'Limits',
  title: 'Limit the servos’ travel',
  needsRobot: true,
  isPerServo: true,
  highlight: ({ servo }) => ({ servo, turnDeg: null }),
  makeElements(dialog) {
    const { calibrator, servo, session, currentTurn } = dialog;
    const limit = calibrator?.calibration.servos[servo].limit ?? null;
    const currentAngle = currentTurn?.commandedDegrees ?? session.robot.description.servos[servo].neutral;
    const [from, to] = limit ?? [0, 0];
    const makeBox = (label: string, value: number, action: (value: number) => void) => numberBox(label, value, '0.01', action);
    return [
      paragraph(`Turn ${formatServo(servo)} until a printed part is about to touch another part, and set the limit there. Skip this step if no parts touch.`),
      row(
        button(`↺ ${TURN_DEG}°`, () => turnServo(dialog, currentAngle + TURN_DEG)),
        button(`↻ ${TURN_DEG}°`, () => turnServo(dialog, currentAngle - TURN_DEG)),
        button('Stand', dialog.stand),
      ),
      ...(limit
        ? [
            row(
              button('Set ↺ limit here', () => setLimit(dialog, 1, currentAngle)),
              button('Set ↻ limit here', () => setLimit(dialog, 0, currentAngle)),
            ),
            row(
              makeBox('From, degrees', from, (value) => setLimit(dialog, 0, value)),
              makeBox('to, degrees', to, (value) => setLimit(dialog, 1, value)),
            ),
          ]
        : []),
      note('The travel goes counter-clockwise from the first angle to the second angle. A limit that would make a gait impossible is refused.'),
    ];
  },
};

function turnServo(dialog: SetupDialog, commandedDegrees: number): void {
  const { servo, run } = dialog;
  run(async (calibrator) => {
    const angle = await calibrator.moveServo(servo, commandedDegrees);
    dialog.lastTurn = { step: limitsStep, servo, commandedDegrees };
    return `A${servo + 1} points to ${angle.toFixed(2)}°.`;
  });
}

/** Sets an end of the travel, 0 for the first or 1 for the second, and keeps the other end. */
function setLimit({ servo, run, markDone }: SetupDialog, end: 0 | 1, angle: number): void {
  run(async (calibrator) => {
    // Another part of the page may have changed the other end since the buttons were drawn.
    const [from, to] = calibrator.calibration.servos[servo].limit;
    await calibrator.setLimit(servo, end === 0 ? angle : from, end === 1 ? angle : to);
    markDone('Limits');
    const [min, max] = calibrator.calibration.servos[servo].limit;
    return `A${servo + 1} travels from ${min.toFixed(2)}° to ${max.toFixed(2)}°.`;
  });
}
