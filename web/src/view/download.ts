// Saves files, and a robot.toml with the values of the page's sliders.
import { type Floor, isRefused, type Refused, Robot } from '../robot';
import { make } from './make';

/**
 * Saves a robot.toml with this floor, mass, feet and leg drive; for null, the text keeps its own values. If the
 * values cannot be written into the text, it is saved unchanged and the reason is returned.
 */
export function downloadRobot(toml: string, floor: Floor | null): Refused | null {
  const edited = floor && Robot.editFloor(toml, floor);
  const refusal = edited && (isRefused(edited) ? edited : edited.refusal);
  const text = !edited || isRefused(edited) || refusal ? toml : edited.text;
  saveFile('robot.toml', [text], 'application/toml');
  return refusal;
}

/** Saves a file. */
export function saveFile(name: string, pieces: BlobPart[], type: string): void {
  const link = make('a', { href: URL.createObjectURL(new Blob(pieces, { type })), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}
