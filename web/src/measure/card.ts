// Formats the results as a table, as an SVG picture to share, and as CSV for a spreadsheet.
import type { Part, Report } from '../../generated/measure';

// Layout of the picture, px.
const PICTURE_WIDTH = 700;
const LINE_HEIGHT = 22;
const TITLE_HEIGHT = 64;
/** Left edges of the columns. */
const COLUMN_LEFTS = [24, 130, 220, 290, 390, 520, 590];
const PARTS = ['forward', 'left', 'turn'] as const;
const PART_NAMES = ['ahead, mm', 'left, mm', 'turn, deg'];
const CSV_FIELDS = ['mean', 'sd', 'error', 'predicted', 'differs'] as const;

/** Formats a number with its sign and two decimals; a dash if there is none. */
const formatSigned = (value: number | null | undefined) => (value == null ? '–' : `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`);

/** Compares a measured mean with its prediction, in standard errors. */
function comparisonText({ agrees, differs }: Part): string {
  if (agrees === null || differs === null) return '–';
  return agrees ? 'agrees' : `${Math.abs(differs).toFixed(1)} errors ${differs > 0 ? 'more' : 'less'}`;
}

/** Returns the column headings of a gait's table. Only some robots at full speed have a column for MuJoCo. */
export const columnHeadings = ({ mujoco }: Report) => ['a cycle', 'measured', 'error', 'predicted', '', 'sd', ...(mujoco ? ['MuJoCo'] : [])];

export const titleOf = ({ gait, speed, cycles }: Report) => `${gait}, ${speed} %, ${cycles} cycles`;

/** Returns the rows of a gait's table, one for each part of its movement. */
export function resultRows(report: Report): string[][] {
  return PARTS.map((name, i) => {
    const part = report[name];
    const mujocoCell = report.mujoco ? [formatSigned(report.mujoco[i])] : [];
    return [PART_NAMES[i] ?? '', formatSigned(part.mean), part.error.toFixed(2), formatSigned(part.predicted), comparisonText(part), part.sd.toFixed(2), ...mujocoCell];
  });
}

/** Returns a sentence that gives the range of a prediction; empty without a range. */
export function rangeSentence({ range }: Report): string {
  if (!range) return '';
  const [name = '', unit = ''] = range.part.split(', ');
  const endText = (value: number, assumption: string | null) => `${formatSigned(value)} ${unit} (${assumption ?? 'as in robot.toml'})`;
  return `Predicted ${name} if one assumption is otherwise: ${endText(range.least, range.least_by)} to ${endText(range.most, range.most_by)}.`;
}

const escapeText = (text: string) => text.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
const textElement = (x: number, y: number, content: string, attributes = '') => `<text x="${x}" y="${y}" ${attributes}>${escapeText(content)}</text>`;

/** Returns an SVG picture of the results of a robot's gaits. */
export function svgCard(robot: string, gaits: Report[]): string {
  let y = TITLE_HEIGHT;
  const rowElements = (cells: string[], attributes = '') => {
    y += LINE_HEIGHT;
    return cells.map((cell, i) => textElement(COLUMN_LEFTS[i] ?? 0, y, cell, attributes)).join('');
  };
  const body = gaits
    .map((report) => {
      y += LINE_HEIGHT / 2;
      return rowElements([titleOf(report)], 'font-weight="bold"') + rowElements(columnHeadings(report), 'fill="#5a5f57"') + resultRows(report).map((line) => rowElements(line)).join('') + rowElements([rangeSentence(report)], 'fill="#5a5f57" font-size="12"');
    })
    .join('');
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${PICTURE_WIDTH}" height="${y + LINE_HEIGHT}" viewBox="0 0 ${PICTURE_WIDTH} ${y + LINE_HEIGHT}" font-family="sans-serif" font-size="15" fill="#20231f">` +
    `<rect width="100%" height="100%" fill="#fff"/>${textElement(24, 40, `${robot}, measured by a camera`, 'font-size="20" font-weight="bold"')}${body}</svg>`
  );
}

/** Returns the results as CSV: a heading, and one line for each gait. */
export function resultsCsv(gaits: Report[]): string {
  const csvLine = (report: Report) => [report.gait, report.speed, report.cycles, ...PARTS.flatMap((part) => CSV_FIELDS.map((field) => report[part][field] ?? ''))];
  const headings = ['gait', 'speed', 'cycles', ...PARTS.flatMap((part) => CSV_FIELDS.map((field) => `${part}_${field}`))];
  return [headings, ...gaits.map(csvLine)].map((cells) => `${cells.join(',')}\n`).join('');
}
