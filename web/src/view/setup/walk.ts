// The First walk step, in which the robot walks with its new calibration before the user saves it.
import { button, note, row, warning, paragraph } from '../elements';
import { findUncheckedServos } from './signs';
import type { Step } from './step';

export const walkStep: Step = {
  name: 'First walk',
  title: 'The first walk',
  needsRobot: true,
  makeElements(dialog) {
    const { run, perform, stand, markDone, session } = dialog;
    const uncheckedServos = findUncheckedServos(dialog);
    const isWalking = session.robot.description.gaits.some(({ command, moves }) => moves && command === session.board.gait);
    const startWalk = () =>
      run(async (calibrator) => {
        const gait = await calibrator.startWalk();
        if (gait === undefined) return 'This robot has no gait.';
        markDone('First walk');
        return `The robot has started "${gait}".`;
      });
    const saveCalibration = () => perform((calibrator) => calibrator.save(), 'Saved. You may now switch off the power.');
    const isUnsaved = dialog.calibrator?.isChanged ?? false;
    return [
      paragraph('Assemble the robot now (quickstart, step 7). Let it walk first on a box, with its feet in the air, and then on the floor with free space ahead.'),
      ...(isUnsaved ? [paragraph('Without power, unsaved settings are lost.'), row(button('Save first', saveCalibration))] : []),
      ...(uncheckedServos.length > 0 ? [warning(`Not checked yet: the sign of ${uncheckedServos.map((servo) => `A${servo + 1}`).join(', ')}. First go back to Signs.`)] : []),
      row(isWalking ? button('Stand', stand, true) : button('Walk', startWalk, true)),
      note('Esc and the red stop button stop the robot at any time.'),
    ];
  },
};
