// The Horns step, in which each servo holds its middle position while the user presses the crank onto the shaft.
import { button, list, note, row, paragraph } from '../elements';
import type { Step } from './step';

export const hornsStep: Step = {
  name: 'Horns',
  title: 'Fit the horns',
  needsRobot: true,
  highlight: () => null,
  makeElements({ perform }) {
    const rest = () => perform((calibrator) => calibrator.rest(), 'The pulses have ended. Switch on the servos\' supply now.');
    const centerServos = () =>
      perform((calibrator) => calibrator.centerServos(), 'Every servo now holds its middle position (pulse width 1500 µs).', 'Horns');
    return [
      paragraph('The shafts are still empty, and each horn is screwed into its crank. First end the pulses, so that no servo moves; then switch on the servos\' supply.'),
      row(button('Let the servos rest', rest), button('Turn all servos to their middle', centerServos, true)),
      list(
        'Press each crank onto its shaft, as near to the angle in the drawing as the teeth allow. The dashed line is at 0°.',
        'Do not turn a crank by force while its servo has power; lift it off and refit it.',
        'Insert the horns\' own screws. Do not connect the cranks to the other links before the signs are checked.',
      ),
      note('The 25 teeth are 14.4° apart; a crank is therefore off by at most 7.2°, which its trim corrects later. If the horns are already fitted, continue.'),
    ];
  },
};
