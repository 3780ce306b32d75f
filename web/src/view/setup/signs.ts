// The Signs step, in which the user checks each servo's direction of rotation. A servo with a wrong sign turns to the
// other side of its neutral angle; the guard would therefore accept an unsafe pose.
import type { SetupDialog } from '../setup';
import { formatServo, SERVO_POSITIONS } from './drawing';
import { button, note, row, paragraph } from '../elements';
import type { Step, Turn } from './step';

/** Returns the key that marks a servo's sign as checked. */
const toSignKey = (servo: number) => `sign ${servo}`;

/** Returns the servos whose signs have not been checked yet. */
export const findUncheckedServos = (dialog: SetupDialog): number[] => [0, 1, 2, 3].filter((servo) => !dialog.isDone(toSignKey(servo)));

export const signsStep: Step = {
  name: 'Signs',
  title: 'Check the signs',
  needsRobot: true,
  isPerServo: true,
  highlight: ({ servo, currentTurn }) => ({ servo, turnDeg: currentTurn?.commandedDegrees ?? 10 }),
  makeElements(dialog) {
    const { servo, currentTurn } = dialog;
    const name = `A${servo + 1}`;
    return [
      paragraph(`${formatServo(servo)}: only this servo turns, by 10° or less. Look from above.`),
      row(button(currentTurn ? `Turn ${name} again` : `Turn ${name}`, () => turnServo(dialog), !currentTurn)),
      ...(currentTurn ? makeQuestion(dialog, currentTurn) : []),
      note('Do not skip this step: with a wrong sign, the robot would treat an unsafe pose as safe.'),
    ];
  },
};

function makeQuestion(dialog: SetupDialog, turn: Turn): Node[] {
  const { servo, session } = dialog;
  const { pin } = session.robot.description.servos[servo];
  const recordFault = (fault: 'otherServo' | 'noServo') => () => {
    turn.fault = fault;
    dialog.redraw();
  };
  const advice = {
    otherServo: `Two signal wires are swapped. Switch off the servo supply and connect the signal of the ${SERVO_POSITIONS[servo]} servo to pin D${pin}. Then turn the servo again.`,
    noServo: `Check that the servo supply is on, that its ground is connected to the UNO's ground, and that the servo's plug is the right way round, with the signal (orange) on pin D${pin}. Then turn the servo again.`,
  };
  return [
    paragraph('Did the servo turn in the direction of the arrow?'),
    row(
      button('Yes', () => confirmSign(dialog), true),
      button('No, in the other direction', () => reverseSign(dialog)),
      button('Another servo turned', recordFault('otherServo')),
      button('No servo turned', recordFault('noServo')),
    ),
    ...(turn.fault ? [paragraph(advice[turn.fault])] : []),
  ];
}

function turnServo(dialog: SetupDialog): void {
  const { servo, run } = dialog;
  run(async (calibrator) => {
    const commandedDegrees = await calibrator.turnToCheckSign(servo);
    dialog.lastTurn = { step: signsStep, servo, commandedDegrees };
    return `A${servo + 1} received the command to turn by ${Math.abs(commandedDegrees)}° ${commandedDegrees > 0 ? 'counter-clockwise' : 'clockwise'}.`;
  });
}

function reverseSign(dialog: SetupDialog): void {
  const { servo, run } = dialog;
  run(async (calibrator) => {
    await calibrator.reverseSign(servo);
    dialog.lastTurn = null;
    return `The sign of A${servo + 1} is now "${calibrator.calibration.servos[servo].dir}". Turn it again and check.`;
  });
}

/** Marks this sign as checked and goes to the next unchecked servo, or to the next step. */
function confirmSign(dialog: SetupDialog): void {
  dialog.markDone(toSignKey(dialog.servo));
  dialog.lastTurn = null;
  const [nextServo] = findUncheckedServos(dialog);
  if (nextServo !== undefined) {
    dialog.servo = nextServo;
    dialog.redraw();
    return;
  }
  dialog.markDone('Signs');
  dialog.perform((calibrator) => calibrator.stand(), 'All four servos turn in the right direction.');
  dialog.goTo('Trims');
}
