// The Trims step, in which the user corrects each crank's angle in small steps that take effect at once.
import { formatServo } from './drawing';
import { button, note, row, paragraph } from '../elements';
import type { Step } from './step';

/** The trim changes of the buttons, deg counter-clockwise. */
const TRIM_CHANGES = [0.5, 0.1, -0.1, -0.5];

export const trimsStep: Step = {
  name: 'Trims',
  title: 'Straighten the cranks',
  needsRobot: true,
  isPerServo: true,
  highlight: ({ servo }) => ({ servo, turnDeg: null }),
  makeElements({ calibrator, servo, run, stand, markDone, session }) {
    const trim = calibrator?.calibration.servos[servo].trim;
    const neutralText = session.robot.description.servos[servo].neutral.toFixed(1);
    const changeTrim = (change: number) => () =>
      run(async (calibrator) => {
        await calibrator.changeTrim(servo, change);
        markDone('Trims');
        return `The trim of A${servo + 1} is ${calibrator.calibration.servos[servo].trim.toFixed(2)}°.`;
      });
    return [
      paragraph(`Make the robot stand, and change the trim until the crank of ${formatServo(servo)} points to ${neutralText}°, or mirrors the crank on the other side.`),
      row(button('Stand', stand, true)),
      row(...TRIM_CHANGES.map((change) => button(`${change > 0 ? '↺' : '↻'} ${Math.abs(change)}°`, changeTrim(change)))),
      paragraph(`Trim: ${trim === undefined ? '–' : `${trim.toFixed(2)}°`}`),
      note('↺ is counter-clockwise as seen from above. If a trim exceeds 7.2°, move the horn by one tooth.'),
    ];
  },
};
