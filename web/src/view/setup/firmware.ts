// The step Firmware: writes firmware and robot through the boot loader.
import { answerOf, nameOf } from './board';
import { BY_CABLE } from '../../session';
import { button, note, row, warning, words } from '../make';
import type { Step } from './step';

export const firmware: Step = {
  name: 'Firmware',
  title: 'Write the firmware and this robot',
  needsRobot: false,
  parts({ session, write, go }) {
    const { link, banner, hasThisRobot } = session;
    if (link.kind === 'radio') return [words(answerOf(session)), warning(`Nothing can be written here: ${BY_CABLE}.`)];
    const allButton = button('Write firmware and robot', () => write('all'), !session.answers);
    const robotButton = button('Write this robot alone', () => write('robot'), !hasThisRobot);
    return [
      words(answerOf(session)),
      words(
        `This writes ${nameOf(session)} to the ${link.name}, reads it back and starts it. A calibration that was saved on it stays. ` +
          'The firmware is the same for every robot: where it is there already, the robot alone takes about a second.',
      ),
      row(...(banner && session.answers ? [robotButton] : []), allButton, ...(hasThisRobot ? [button('Go on', () => go('Horns'), true)] : [])),
      note('Is it another robot that you have built? Choose it at the top of the page first, or open its robot.toml.'),
    ];
  },
};
