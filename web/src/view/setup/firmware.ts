// The Firmware step, which writes the firmware and the robot through the boot loader.
import { describeBoard, formatRobotName } from './board';
import { NO_WRITING_BY_RADIO } from '../../board-program';
import { button, note, row, warning, paragraph } from '../elements';
import type { Step } from './step';

export const firmwareStep: Step = {
  name: 'Firmware',
  title: 'Write the firmware and this robot',
  needsRobot: false,
  makeElements({ session, write, goTo }) {
    const { link, banner } = session.board;
    const { hasThisRobot, isFirmwareAnswering } = session.program;
    if (link.kind === 'radio') return [paragraph(describeBoard(session)), warning(`The page cannot write to this board: ${NO_WRITING_BY_RADIO}.`)];
    const allButton = button('Write firmware and robot', () => write('all'), !isFirmwareAnswering);
    const robotButton = button('Write this robot alone', () => write('robot'), !hasThisRobot);
    return [
      paragraph(describeBoard(session)),
      paragraph(
        `This writes ${formatRobotName(session.robot)} to the ${link.name}, verifies it and starts the board. A saved calibration stays. ` +
          'The firmware is the same for every robot; on a board that already has it, writing the robot alone takes about a second.',
      ),
      row(...(banner && isFirmwareAnswering ? [robotButton] : []), allButton, ...(hasThisRobot ? [button('Continue', () => goTo('Horns'), true)] : [])),
      note('If you have built another robot, first choose it at the top of the page, or open its robot.toml.'),
    ];
  },
};
