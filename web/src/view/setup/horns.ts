// The step Horns, in which each servo holds the middle of its travel while the user presses its crank on.
import { button, list, note, row, paragraph } from '../make';
import type { Step } from './step';

export const hornsStep: Step = {
  name: 'Horns',
  title: 'Fit the horns',
  needsRobot: true,
  selectedServo: () => null,
  makeElements: ({ run, markDone }) => [
    paragraph('Nothing is on the shafts yet, and each horn is screwed into its link. First end the pulses; then switch on the servos\' supply, so that nothing starts.'),
    row(
      button('Let the servos rest', () =>
        run(async (guide) => {
          await guide.rest();
          return 'No pulses now: switch on the servos\' supply.';
        }),
      ),
      button(
        'Turn all servos to their middle',
        () =>
          run(async (guide) => {
            await guide.center();
            markDone('Horns');
            return 'Every servo holds its middle now, a pulse of 1500 µs.';
          }),
        true,
      ),
    ),
    list(
      'Press each crank on as near to the angle in the drawing as the teeth allow. The dashed line is where angles begin.',
      'Do not turn a crank by force while its servo has power: lift it off and put it on again.',
      'Put the horns\' own screws in. Nothing may join the links before the signs are proven.',
    ),
    note('25 teeth are 14.4° apart, so a crank is off by 7.2° at most; its trim corrects that later. If the horns are on already, go on.'),
  ],
};
