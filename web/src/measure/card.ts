// Formats the results as a table, as an SVG picture to share, and as CSV for a spreadsheet.
import type { Part, Report } from '../../generated/measure';

// Layout of the picture, px: its width, the height of a line, that of the title, the left edges of the columns.
const WIDTH = 700;
const LINE = 22;
const HEAD = 64;
const COLUMNS = [24, 130, 220, 290, 390, 520, 590];
const PARTS = ['forward', 'left', 'turn'] as const;
const PART_NAMES = ['ahead, mm', 'left, mm', 'turn, deg'];
const FIELDS = ['mean', 'sd', 'error', 'predicted', 'differs'] as const;

/** A number with its sign and two decimals; a dash if there is none. */
const signed = (value: number | null | undefined) => (value == null ? '–' : `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`);

/** The comparison of a measured mean with its prediction, in standard errors. */
function verdict({ agrees, differs }: Part): string {
  if (agrees === null || differs === null) return '–';
  return agrees ? 'agrees' : `${Math.abs(differs).toFixed(1)} errors ${differs > 0 ? 'more' : 'less'}`;
}

/** The column headings of a gait's table. MuJoCo's column is there only for some robots at full speed. */
export const columnHeadings = ({ mujoco }: Report) => ['a cycle', 'measured', 'error', 'predicted', '', 'sd', ...(mujoco ? ['MuJoCo'] : [])];

export const titleOf = ({ gait, speed, cycles }: Report) => `${gait}, ${speed} %, ${cycles} cycles`;

/** The rows of a gait's table, one for each part of its movement. */
export function rows(report: Report): string[][] {
  return PARTS.map((name, i) => {
    const part = report[name];
    const mujocoCell = report.mujoco ? [signed(report.mujoco[i])] : [];
    return [PART_NAMES[i] ?? '', signed(part.mean), part.error.toFixed(2), signed(part.predicted), verdict(part), part.sd.toFixed(2), ...mujocoCell];
  });
}

/** A sentence that gives the range of a prediction; empty without a range. */
export function rangeOf({ range }: Report): string {
  if (!range) return '';
  const [name = '', unit = ''] = range.part.split(', ');
  const end = (value: number, by: string | null) => `${signed(value)} ${unit} (${by ?? 'as in robot.toml'})`;
  return `Predicted ${name} if one assumption is otherwise: ${end(range.least, range.least_by)} to ${end(range.most, range.most_by)}.`;
}

const escaped = (text: string) => text.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
const text = (x: number, y: number, words: string, more = '') => `<text x="${x}" y="${y}" ${more}>${escaped(words)}</text>`;

/** An SVG picture of the results of a robot's gaits. */
export function card(robot: string, gaits: Report[]): string {
  let y = HEAD;
  const row = (cells: string[], more = '') => {
    y += LINE;
    return cells.map((cell, i) => text(COLUMNS[i] ?? 0, y, cell, more)).join('');
  };
  const body = gaits
    .map((report) => {
      y += LINE / 2;
      return row([titleOf(report)], 'font-weight="bold"') + row(columnHeadings(report), 'fill="#5a5f57"') + rows(report).map((line) => row(line)).join('') + row([rangeOf(report)], 'fill="#5a5f57" font-size="12"');
    })
    .join('');
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${y + LINE}" viewBox="0 0 ${WIDTH} ${y + LINE}" font-family="sans-serif" font-size="15" fill="#20231f">` +
    `<rect width="100%" height="100%" fill="#fff"/>${text(24, 40, `${robot}, measured by a camera`, 'font-size="20" font-weight="bold"')}${body}</svg>`
  );
}

/** The results as CSV: a heading, and one line for each gait. */
export function csv(gaits: Report[]): string {
  const line = (report: Report) => [report.gait, report.speed, report.cycles, ...PARTS.flatMap((part) => FIELDS.map((field) => report[part][field] ?? ''))];
  const head = ['gait', 'speed', 'cycles', ...PARTS.flatMap((part) => FIELDS.map((field) => `${part}_${field}`))];
  return [head, ...gaits.map(line)].map((cells) => `${cells.join(',')}\n`).join('');
}
