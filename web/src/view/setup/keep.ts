// The Keep step, which saves the calibration in the board and as a file.
import { formatCalibration } from '../../robot';
import { formatServo } from './drawing';
import { saveFile } from '../download';
import { button, make, note, onFile, row, table, paragraph } from '../elements';
import type { Step } from './step';

export const keepStep: Step = {
  name: 'Keep',
  title: 'Save the calibration, also as a file',
  needsRobot: true,
  makeElements({ calibrator, perform, run, setCalibration, isDone }) {
    if (!calibrator) return [paragraph('Reading the calibration…')];
    const { servos } = calibrator.calibration;
    const rows = servos.map(({ trim, limit, dir, scale }, servo) => [
      formatServo(servo),
      dir,
      `${trim.toFixed(2)}°`,
      `${limit[0].toFixed(2)}° to ${limit[1].toFixed(2)}°`,
      scale.toFixed(2),
    ]);
    const saveCalibration = () =>
      perform((calibrator) => calibrator.save(), 'Saved: the board starts with it from now on, even with new firmware.', 'Keep');
    const saveAsFile = () =>
      run(async (calibrator) => {
        saveFile('calibration.toml', [formatCalibration(calibrator.calibration)], 'application/toml');
        return 'The calibration was written to the file.';
      });
    const fileInput = make('input', { type: 'file', accept: '.toml' });
    onFile(fileInput, (file) => void file.text().then((text) => setCalibration(text, file.name)));
    return [
      table('Calibration of the robot', ['servo', 'sign', 'trim', 'limits', 'µs per °'], rows),
      paragraph(calibrator.isChanged ? 'Not saved yet.' : isDone('Keep') ? 'Saved in the board.' : 'No setting has changed since the board was connected.'),
      row(button('Save in the board', saveCalibration, calibrator.isChanged), button('Save as a file', saveAsFile)),
      row(make('label', { className: 'file' }, 'Open a saved file ', fileInput)),
      note('The file has the format of `lizard calibrate backup`. An opened file takes effect at once; the button saves it in the board.'),
    ];
  },
};
