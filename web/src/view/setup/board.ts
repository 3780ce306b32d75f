// The step Board, in which the user connects a board.
import { bluetoothProblem } from '../../link/bluetooth-link';
import { hasSerial, NO_SERIAL_MESSAGE } from '../../link/port-link';
import type { Session } from '../../session';
import { button, list, note, row, warning, paragraph } from '../make';
import type { Step } from './step';

/** Returns the name of the page's robot for messages. */
export function robotName({ file, toml, original }: Session): string {
  return toml === original ? `${file}.toml` : `${file}.toml with your changes`;
}

/** Returns a message that names the connected board and the firmware and robot on it. */
export function boardDescription(session: Session): string {
  const { link, banner } = session;
  if (banner === undefined) return `The ${link.name} has not identified itself yet.`;
  if (banner === null && session.isReal && !session.hasBootLoader) return `The ${link.name} answers neither as this firmware nor as a boot loader. Is it the right port, and a UNO?`;
  if (banner === null) return `The ${link.name} is a UNO by its boot loader, and this firmware is not on it.`;
  if (banner === 'unknown') return `The ${link.name} has this firmware. It names its robot only after its reset button is pressed.`;
  if (session.hasThisRobot) return `The ${link.name} has this firmware and this robot, ${robotName(session)}.`;
  if (!banner.robot) return `The ${link.name} has this firmware and no robot, so it moves nothing. Write this one.`;
  return `The ${link.name} has this firmware and another robot, ${banner.robot.name} ${banner.robot.hash}. Choose that robot above, or write this one.`;
}

export const boardStep: Step = {
  name: 'Board',
  title: 'Connect the board',
  needsRobot: false,
  makeElements({ session, connect, goTo }) {
    if (session.isReal) {
      return [
        paragraph(boardDescription(session)),
        row(button(session.isFirmwareAnswering ? 'Go on' : 'Write the firmware', () => goTo('Firmware'), true), button('Disconnect', connect)),
      ];
    }
    const elements = [
      list(
        'The servos\' own supply, 5 V and 3 A, stays off until the horns are fitted. The board needs its USB cable alone.',
        'The USB cable has to carry data: some only charge.',
        'Close other programs that use the port, such as a console.',
      ),
      hasSerial() ? row(button('Choose its port…', connect, true)) : warning(NO_SERIAL_MESSAGE),
    ];
    elements.push(note(bluetoothProblem() ?? 'A board that has this firmware already can also be reached by a Bluetooth LE module: Bluetooth… is in this room.'));
    elements.push(note('Without a board, every step can be tried with the simulated one of this page.'));
    return elements;
  },
};
