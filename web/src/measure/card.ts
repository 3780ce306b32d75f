// The results as a picture to share.
import type { Part, Results } from './question';

const WIDTH = 640;
const LINE = 22;
const HEAD = 64;
const COLUMNS = [24, 130, 250, 340, 420, 520];

/** The columns of a table of results; the first is the gait. */
export const COLUMN_NAMES = ['gait', 'a cycle', 'measured', 'sd', 'error', 'predicted', ''];

const signed = (value: number) => `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`;

function verdict({ agrees, differs }: Part): string {
  if (agrees === null || differs === null) return '–';
  return agrees ? 'agrees' : `${Math.abs(differs).toFixed(1)} errors ${differs > 0 ? 'more' : 'less'}`;
}

/** The rows of a table of results. */
export function rows(results: Results[]): string[][] {
  return results.flatMap(({ report }) => {
    const { gait, speed, forward, left, turn } = report;
    const parts: [string, Part][] = [['ahead, mm', forward], ['left, mm', left], ['turn, deg', turn]];
    return parts.map(([name, part], i) => [
      i === 0 ? `${gait}, ${speed} %, ${report.cycles} cycles` : '',
      name,
      signed(part.mean),
      part.sd.toFixed(2),
      part.error.toFixed(2),
      part.predicted === null ? '–' : signed(part.predicted),
      verdict(part),
    ]);
  });
}

const escaped = (text: string) => text.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
const text = (x: number, y: number, words: string, more = '') => `<text x="${x}" y="${y}" ${more}>${escaped(words)}</text>`;

/** An SVG picture of the results of a robot. */
export function card(robot: string, results: Results[]): string {
  const lines = rows(results);
  let y = HEAD;
  const row = ([gait = '', ...cells]: string[], more = '') => {
    const head = gait === '' ? '' : text(COLUMNS[0] ?? 0, (y += LINE * 1.2), gait, 'font-weight="bold"');
    y += LINE;
    return head + cells.map((cell, i) => text(COLUMNS[i] ?? 0, y, cell, more)).join('');
  };
  const body = row(['', ...COLUMN_NAMES.slice(1)], 'fill="#5a5f57"') + lines.map((line) => row(line)).join('');
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${y + LINE}" viewBox="0 0 ${WIDTH} ${y + LINE}" font-family="sans-serif" font-size="15" fill="#20231f">` +
    `<rect width="100%" height="100%" fill="#fff"/>${text(24, 40, `${robot}, measured by a camera`, 'font-size="20" font-weight="bold"')}${body}</svg>`
  );
}

/** The results as a table for a spreadsheet. */
export function csv(results: Results[]): string {
  const parts = ['forward', 'left', 'turn'] as const;
  const fields = ['mean', 'sd', 'error', 'predicted', 'differs'] as const;
  const line = ({ report }: Results) => [report.gait, report.speed, report.cycles, ...parts.flatMap((part) => fields.map((field) => report[part][field] ?? ''))];
  const head = ['gait', 'speed', 'cycles', ...parts.flatMap((part) => fields.map((field) => `${part}_${field}`))];
  return [head, ...results.map(line)].map((cells) => `${cells.join(',')}\n`).join('');
}
