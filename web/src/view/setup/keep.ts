// The step Keep: saves the calibration in the board and as a file.
import { calibrationText } from '../../robot';
import { nameOf } from './drawing';
import { save } from '../download';
import { button, make, note, row, table, words } from '../make';
import type { Step } from './step';

export const keep: Step = {
  name: 'Keep',
  title: 'Save the calibration, also as a file',
  needsRobot: true,
  parts({ guide, run, done, setCalibration, isDone }) {
    if (!guide) return [words('Reading the calibration…')];
    const { servos } = guide.calibration;
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
    const fileInput = make('input', { type: 'file', accept: '.toml' });
    fileInput.addEventListener('change', () => {
      const chosenFile = fileInput.files?.[0];
      if (chosenFile) void chosenFile.text().then((text) => setCalibration(text, chosenFile.name));
    });
    return [
      table('Calibration of the robot', ['servo', 'sign', 'trim', 'limits', 'µs per °'], rows),
      words(guide.isChanged ? 'Not saved yet.' : isDone('Keep') ? 'The board has saved it.' : 'Nothing has changed since the board was connected.'),
      row(button('Save in the board', store, guide.isChanged), button('Save as a file', () => save('calibration.toml', [calibrationText(guide.calibration)], 'application/toml'))),
      row(make('label', { className: 'file' }, 'Open a saved file ', fileInput)),
      note('The file is the same as that of `lizard calibrate backup`. A file that you open takes effect at once; the button saves it in the board.'),
    ];
  },
};
