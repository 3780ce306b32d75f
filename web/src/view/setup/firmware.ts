// The step Firmware, which writes the firmware and the robot through the boot loader.
import { boardDescription, robotName } from './board';
import { NO_WRITING_BY_RADIO } from '../../session';
import { button, note, row, warning, paragraph } from '../make';
import type { Step } from './step';

export const firmwareStep: Step = {
  name: 'Firmware',
  title: 'Write the firmware and this robot',
  needsRobot: false,
  makeElements({ session, write, goTo }) {
    const { link, banner, hasThisRobot } = session;
    if (link.kind === 'radio') return [paragraph(boardDescription(session)), warning(`Nothing can be written here: ${NO_WRITING_BY_RADIO}.`)];
    const allButton = button('Write firmware and robot', () => write('all'), !session.isFirmwareAnswering);
    const robotButton = button('Write this robot alone', () => write('robot'), !hasThisRobot);
    return [
      paragraph(boardDescription(session)),
      paragraph(
        `This writes ${robotName(session)} to the ${link.name}, reads it back and starts it. A calibration that was saved on it stays. ` +
          'The firmware is the same for every robot: where it is there already, the robot alone takes about a second.',
      ),
      row(...(banner && session.isFirmwareAnswering ? [robotButton] : []), allButton, ...(hasThisRobot ? [button('Go on', () => goTo('Horns'), true)] : [])),
      note('Is it another robot that you have built? Choose it at the top of the page first, or open its robot.toml.'),
    ];
  },
};
