// The step First walk, before anything is saved.
import { button, note, row, warning, words } from '../make';
import { unproven } from './signs';
import type { Step } from './step';

export const walk: Step = {
  name: 'First walk',
  title: 'The first walk',
  needsRobot: true,
  parts(tools) {
    const { run, done, session } = tools;
    const unprovenServos = unproven(tools);
    const isWalking = session.description.gaits.some(({ command, moves }) => moves && command === session.gait);
    const begin = () =>
      run(async (guide) => {
        const gait = await guide.walk();
        if (gait === undefined) return 'This robot has no gait.';
        done('First walk');
        return `The robot does "${gait}".`;
      });
    const end = () =>
      run(async (guide) => {
        await guide.stand();
        return 'The robot stands.';
      });
    const store = () =>
      run(async (guide) => {
        await guide.save();
        return 'Saved. The robot may be without power now.';
      });
    const isUnsaved = tools.guide?.isChanged ?? false;
    return [
      words('Put the robot together now (quickstart, step 7). Let it walk first on a box, its feet in the air, then on the floor with room in front of it.'),
      ...(isUnsaved ? [words('Will it be without power for that? What was set is lost then, unless it is saved.'), row(button('Save it before', store))] : []),
      ...(unprovenServos.length > 0 ? [warning(`Not proven yet: the sign of ${unprovenServos.map((servo) => `A${servo + 1}`).join(', ')}. Go back to Signs first.`)] : []),
      row(isWalking ? button('Let it stand', end, true) : button('Let it walk', begin, true)),
      note('Esc and the red stop button end it at any moment.'),
    ];
  },
};
