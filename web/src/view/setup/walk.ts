// The step First walk, in which the robot walks with its new calibration before it is saved.
import { button, note, row, warning, paragraph } from '../make';
import { findUnprovenServos } from './signs';
import type { Step } from './step';

export const walkStep: Step = {
  name: 'First walk',
  title: 'The first walk',
  needsRobot: true,
  makeElements(tools) {
    const { run, stand, markDone, session } = tools;
    const unprovenServos = findUnprovenServos(tools);
    const isWalking = session.description.gaits.some(({ command, moves }) => moves && command === session.gait);
    const startWalk = () =>
      run(async (guide) => {
        const gait = await guide.walk();
        if (gait === undefined) return 'This robot has no gait.';
        markDone('First walk');
        return `The robot does "${gait}".`;
      });
    const saveCalibration = () =>
      run(async (guide) => {
        await guide.save();
        return 'Saved. The robot may be without power now.';
      });
    const isUnsaved = tools.guide?.isChanged ?? false;
    return [
      paragraph('Put the robot together now (quickstart, step 7). Let it walk first on a box, its feet in the air, then on the floor with room in front of it.'),
      ...(isUnsaved ? [paragraph('Will it be without power for that? What was set is lost then, unless it is saved.'), row(button('Save it before', saveCalibration))] : []),
      ...(unprovenServos.length > 0 ? [warning(`Not proven yet: the sign of ${unprovenServos.map((servo) => `A${servo + 1}`).join(', ')}. Go back to Signs first.`)] : []),
      row(isWalking ? button('Let it stand', stand, true) : button('Let it walk', startWalk, true)),
      note('Esc and the red stop button end it at any moment.'),
    ];
  },
};
