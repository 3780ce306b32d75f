// The Board step, in which the user connects a board.
import { findBluetoothProblem } from '../../link/bluetooth-link';
import { hasSerial, NO_SERIAL_MESSAGE } from '../../link/port-link';
import type { Session } from '../../session';
import type { ShownRobot } from '../../shown-robot';
import { button, list, note, row, warning, paragraph } from '../elements';
import type { Step } from './step';

/** Formats the name of the page's robot for messages. */
export function formatRobotName({ file, toml, original }: ShownRobot): string {
  return toml === original ? `${file}.toml` : `${file}.toml with your changes`;
}

/** Returns a message about the connected board, its firmware and its robot. */
export function describeBoard(session: Session): string {
  const { link, banner } = session.board;
  if (banner === undefined) return `The ${link.name} has not identified itself yet.`;
  if (banner === null && session.board.isReal && !session.program.hasBootLoader) return `The ${link.name} answers neither like this firmware nor like a boot loader. Check that the port is right, and that the board is a UNO.`;
  if (banner === null) return `The ${link.name} is a UNO according to its boot loader, without this firmware.`;
  if (banner === 'unknown') return `The ${link.name} has this firmware. Press its reset button to see its robot.`;
  if (session.program.hasThisRobot) return `The ${link.name} has this firmware and this robot, ${formatRobotName(session.robot)}.`;
  if (!banner.robot) return `The ${link.name} has this firmware but no robot; it moves nothing. Write this robot.`;
  return `The ${link.name} has this firmware and another robot, ${banner.robot.name} ${banner.robot.hash}. Choose that robot above, or write this robot.`;
}

export const boardStep: Step = {
  name: 'Board',
  title: 'Connect the board',
  needsRobot: false,
  makeElements({ session, toggleConnection, goTo }) {
    if (session.board.isReal) {
      return [
        paragraph(describeBoard(session)),
        row(button(session.program.isFirmwareAnswering ? 'Continue' : 'Write the firmware', () => goTo('Firmware'), true), button('Disconnect', toggleConnection)),
      ];
    }
    return [
      list(
        'Keep the servos\' supply, 5 V and 3 A, off until you fit the horns. The board needs only its USB cable.',
        'Use a USB cable that carries data; some cables only charge.',
        'Close other programs that use the port, such as a console.',
      ),
      hasSerial() ? row(button('Choose its port…', toggleConnection, true)) : warning(NO_SERIAL_MESSAGE),
      note(findBluetoothProblem() ?? 'A board that already has this firmware can also be connected through a Bluetooth LE module: press “Bluetooth…” in this room.'),
      note('Without a board, you can try every step with the simulated board.'),
    ];
  },
};
