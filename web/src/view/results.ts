// The results of the room Measure: tables on the page, and files to save, share and print.
import { drawResults, formatCsv, listColumnHeadings, formatRange, formatRows, formatTitle } from '../measure/report-formats';
import type { Report } from '../../generated/measure';
import { saveFile } from './download';
import { element, make, note, table } from './elements';

/** Pixels of the PNG per unit of the SVG. */
const PNG_SCALE = 2;

/** Sets the buttons up; returns a function that shows a robot's reports, or hides the section if there are none. */
export function setUpResults(): (robotName: string, reports: Report[]) => void {
  let robotName = '';
  let reports: Report[] = [];
  const drawPicture = () => drawResults(robotName, reports);
  const savePng = async () => {
    const image = new Image();
    image.src = `data:image/svg+xml,${encodeURIComponent(drawPicture())}`;
    await image.decode();
    const canvas = make('canvas', { width: PNG_SCALE * image.width, height: PNG_SCALE * image.height });
    canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
    const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve));
    if (blob) saveFile('measured.png', [blob], 'image/png');
  };
  const onClick = (id: string, action: () => void) => element(`measured-${id}`).addEventListener('click', action);
  onClick('svg', () => saveFile('measured.svg', [drawPicture()], 'image/svg+xml'));
  onClick('png', () => void savePng());
  onClick('csv', () => saveFile('measured.csv', [formatCsv(reports)], 'text/csv'));
  onClick('json', () => saveFile('measured.json', [JSON.stringify({ gaits: reports }, null, 2)], 'application/json'));
  onClick('print', () => print());
  return (newName, newReports) => {
    [robotName, reports] = [newName, newReports];
    element('measure-results').hidden = reports.length === 0;
    const sections = reports.flatMap((report) => [make('h4', {}, formatTitle(report)), table(formatTitle(report), listColumnHeadings(report), formatRows(report)), note(formatRange(report))]);
    element('measured').replaceChildren(...sections);
  };
}
