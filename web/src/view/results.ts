// The results of the room Measure: tables on the page, and files to save, share and print.
import { drawResults, formatCsv, listColumnHeadings, formatRange, formatRows, formatTitle } from '../measure/report-formats';
import type { Report } from '../../generated/measure';
import { saveFile } from './download';
import { element, make, table } from './elements';

/** Pixels of the PNG per unit of the SVG. */
const PNG_SCALE = 2;

export class ResultsView {
  private gaits: Report[] = [];

  /** `robotName` returns the name of the session's robot. */
  constructor(private readonly robotName: () => string) {
    const onClick = (id: string, action: () => void) => element(`measured-${id}`).addEventListener('click', action);
    onClick('svg', () => saveFile('measured.svg', [this.pictureSvg], 'image/svg+xml'));
    onClick('png', () => void this.savePng());
    onClick('csv', () => saveFile('measured.csv', [formatCsv(this.gaits)], 'text/csv'));
    onClick('json', () => saveFile('measured.json', [JSON.stringify({ gaits: this.gaits }, null, 2)], 'application/json'));
    onClick('print', () => print());
  }

  /** Shows the results of these gaits; hides the results if there are none. */
  show(gaits: Report[]): void {
    this.gaits = gaits;
    element('measure-results').hidden = gaits.length === 0;
    const sections = gaits.flatMap((report) => [make('h4', {}, formatTitle(report)), table(formatTitle(report), listColumnHeadings(report), formatRows(report)), make('p', { className: 'note' }, formatRange(report))]);
    element('measured').replaceChildren(...sections);
  }

  private get pictureSvg(): string {
    return drawResults(this.robotName(), this.gaits);
  }

  private async savePng(): Promise<void> {
    const image = new Image();
    image.src = `data:image/svg+xml,${encodeURIComponent(this.pictureSvg)}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), { width: PNG_SCALE * image.width, height: PNG_SCALE * image.height });
    canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
    const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve));
    if (blob) saveFile('measured.png', [blob], 'image/png');
  }
}
