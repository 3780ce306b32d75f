// Formats measured gaits as tables, as an SVG picture to share, and as CSV.
import type { Component, Report } from '../../generated/measure';

// The layout of the picture, px.
const PICTURE_WIDTH = 700;
const LINE_HEIGHT = 22;
const TITLE_HEIGHT = 64;
/** Left edges of the columns, px. */
const COLUMN_LEFTS = [24, 130, 220, 290, 390, 575, 628];
/** The keys of the components of a cycle's movement in a report. */
const COMPONENT_KEYS = ['forward', 'left', 'turn'] as const;
const COMPONENT_LABELS = ['ahead, mm', 'left, mm', 'turn, deg'];
const CSV_FIELDS = ['mean', 'sd', 'error', 'predicted', 'differs'] as const;

/** Formats a number with its sign and two decimals, and null as a dash. */
const formatSigned = (value: number | null | undefined) => (value == null ? '–' : `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`);

/** Formats the comparison of a measured mean with its prediction, in standard errors. */
function formatComparison({ agrees, differs }: Component): string {
  if (agrees === null || differs === null) return '–';
  return agrees ? 'agrees' : `${Math.abs(differs).toFixed(1)} std. errors ${differs > 0 ? 'more' : 'less'}`;
}

/** Returns the column headings of a gait's table; the last is MuJoCo's if the report has its result. */
export const listColumnHeadings = ({ mujoco }: Report) => ['per cycle', 'measured', 'error', 'predicted', '', 'sd', ...(mujoco ? ['MuJoCo'] : [])];

/** Formats the title of a gait's table. */
export const formatTitle = ({ gait, speed, cycles }: Report) => `${gait}, ${speed} %, ${cycles} cycles`;

/** Formats the rows of a gait's table, one for each component of the movement. */
export function formatRows(report: Report): string[][] {
  return COMPONENT_KEYS.map((key, i) => {
    const component = report[key];
    const mujocoCell = report.mujoco ? [formatSigned(report.mujoco[i])] : [];
    return [COMPONENT_LABELS[i] ?? '', formatSigned(component.mean), component.error.toFixed(2), formatSigned(component.predicted), formatComparison(component), component.sd.toFixed(2), ...mujocoCell];
  });
}

/** Formats the range of a prediction as a sentence in lines; no lines if there is no range. */
function listRangeLines({ range }: Report): string[] {
  if (!range) return [];
  const [name = '', unit = ''] = range.part.split(', ');
  const formatBound = (value: number, assumption: string | null) => `${formatSigned(value)} ${unit} (${assumption ?? 'as in robot.toml'})`;
  return [`Predicted ${name} with one assumption changed:`, `${formatBound(range.least, range.least_by)} to`, `${formatBound(range.most, range.most_by)}.`];
}

/** Formats the range of a prediction as a sentence; empty if there is no range. */
export const formatRange = (report: Report) => listRangeLines(report).join(' ');

const escapeText = (text: string) => text.replace(/[&<>]/g, (character) => `&#${character.charCodeAt(0)};`);
const formatTextElement = (x: number, y: number, content: string, attributes = '') => `<text x="${x}" y="${y}" ${attributes}>${escapeText(content)}</text>`;

/** Draws the results of a robot's gaits as SVG. */
export function drawResults(robotName: string, reports: Report[]): string {
  let y = TITLE_HEIGHT;
  const drawRow = (cells: string[], attributes = '') => {
    y += LINE_HEIGHT;
    return cells.map((cell, i) => formatTextElement(COLUMN_LEFTS[i] ?? 0, y, cell, attributes)).join('');
  };
  const body = reports
    .map((report) => {
      y += LINE_HEIGHT / 2;
      return drawRow([formatTitle(report)], 'font-weight="bold"') + drawRow(listColumnHeadings(report), 'fill="#5a5f57"') + formatRows(report).map((row) => drawRow(row)).join('') + listRangeLines(report).map((line) => drawRow([line], 'fill="#5a5f57" font-size="12"')).join('');
    })
    .join('');
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${PICTURE_WIDTH}" height="${y + LINE_HEIGHT}" viewBox="0 0 ${PICTURE_WIDTH} ${y + LINE_HEIGHT}" font-family="sans-serif" font-size="15" fill="#20231f">` +
    `<rect width="100%" height="100%" fill="#fff"/>${formatTextElement(24, 40, `${robotName}, measured with a camera`, 'font-size="20" font-weight="bold"')}${body}</svg>`
  );
}

/** Formats the results as CSV: a heading, and one line for each gait. */
export function formatCsv(reports: Report[]): string {
  const listCells = (report: Report) => [report.gait, report.speed, report.cycles, ...COMPONENT_KEYS.flatMap((key) => CSV_FIELDS.map((field) => report[key][field] ?? ''))];
  const headings = ['gait', 'speed', 'cycles', ...COMPONENT_KEYS.flatMap((key) => CSV_FIELDS.map((field) => `${key}_${field}`))];
  return [headings, ...reports.map(listCells)].map((cells) => `${cells.join(',')}\n`).join('');
}
