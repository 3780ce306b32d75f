// The step Keep: saves the calibration in the board and as a file.
import { fileOf } from '../../setup/calibration-file';
import { nameOf } from './drawing';
import { button, note, row, save, table, words } from './parts';
import type { Step } from './step';

export const keep: Step = {
  name: 'Keep',
  title: 'Save it, and keep a file',
  needsRobot: true,
  parts({ guide, run, done, give, isDone }) {
    if (!guide) return [words('The robot is asked what it has.')];
    const { servos } = guide.has;
    const rows = servos.map(({ trim, limit, dir, scale }, servo) => [
      nameOf(servo),
      dir,
      `${trim.toFixed(2)}°`,
      `${limit[0].toFixed(2)}° to ${limit[1].toFixed(2)}°`,
      scale.toFixed(2),
    ]);
    const store = () =>
      run(async (guide) => {
        await guide.save();
        done('Keep');
        return 'Saved: the board begins with it from now on, also after new firmware.';
      });
    const file = document.createElement('input');
    file.type = 'file';
    file.accept = '.toml';
    file.addEventListener('change', () => {
      const chosen = file.files?.[0];
      if (chosen) void chosen.text().then((text) => give(text, chosen.name));
    });
    const label = document.createElement('label');
    label.className = 'file';
    label.append('A file that was kept ', file);
    return [
      table('What the robot has', ['servo', 'sign', 'trim', 'limits', 'µs per °'], rows),
      words(guide.isChanged ? 'Not saved yet.' : isDone('Keep') ? 'The board has saved it.' : 'Nothing of it was changed since it was connected.'),
      row(button('Save in the board', store, guide.isChanged), button('Keep as a file', () => save('calibration.toml', 'application/toml', fileOf(guide.has)))),
      row(label),
      note('The file is that of `lizard backup`. A kept file is given to the robot at once, and is saved only by the button.'),
    ];
  },
};
