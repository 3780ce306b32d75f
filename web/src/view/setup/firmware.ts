// The firmware for this robot, written by the board's boot loader.
import { answerOf } from './board';
import { button, note, row, warning, words } from './parts';
import type { Step } from './step';

export const firmware: Step = {
  name: 'Firmware',
  title: 'Write the firmware for this robot',
  needsRobot: false,
  parts({ session, write, go }) {
    const { link, image, file, has, description } = session;
    if (!link.canFlash) return [words('These lengths have no image yet, so the page runs the robot without a chip: there is nothing to write. The steps can still be tried.')];
    if (image === null) {
      return [warning(`No image of ${file}.toml with these lengths was built with the page. Take the lengths of the file, or build it with \`make firmware\` and write its HEX file under Flash.`)];
    }
    const isThere = has === description.hash;
    return [
      words(answerOf(session)),
      words(`This writes ${file}.toml's firmware to the ${link.name}, reads it back and starts it. A calibration that was saved on it stays.`),
      row(button(isThere ? 'Write it once more' : `Write the firmware of ${file}.toml`, write, !isThere), ...(isThere ? [button('Go on', () => go('Horns'), true)] : [])),
      note('Is it another robot that you have built? Choose it at the top of the page first.'),
    ];
  },
};
