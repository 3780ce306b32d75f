// Saves files on the user's machine, for example robot.toml with the values of the page's sliders.
import { type Floor, isRefused, type Refusal, Robot } from '../robot';
import { make } from './elements';

/** Time in which a browser begins to read a file that it saves, ms. */
const SAVE_MS = 60_000;

/**
 * Saves a robot.toml with this floor, mass, feet and leg drive; null keeps the values of the text. If the values cannot
 * be written, saves the text unchanged and returns the reason.
 */
export function downloadRobot(toml: string, floor: Floor | null): Refusal | null {
  const edited = floor && Robot.editFloor(toml, floor);
  const refusal = edited && (isRefused(edited) ? edited : edited.refusal);
  const text = !edited || isRefused(edited) || refusal ? toml : edited.text;
  saveFile('robot.toml', [text], 'application/toml');
  return refusal;
}

/** Saves a file with this content and MIME type. */
export function saveFile(name: string, pieces: BlobPart[], type: string): void {
  const link = make('a', { href: URL.createObjectURL(new Blob(pieces, { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), SAVE_MS);
}
