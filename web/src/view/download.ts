// What the browser saves for a person: files, and a robot.toml with what the page's sliders set.
import { type Floor, isRefused, type Refused, type Robot } from '../robot';

/**
 * Has the browser save a robot.toml with this floor, weight and these springs; null leaves those of the text.
 * Where they have no place in it, the text is saved as it is, and why is returned.
 */
export function download(robot: Robot, toml: string, floor: Floor | null): Refused | null {
  const whole = floor && robot.editFloor(toml, floor);
  const refused = whole && (isRefused(whole) ? whole : whole.refusal);
  const text = !whole || isRefused(whole) || refused ? toml : whole.text;
  save('robot.toml', [text], 'application/toml');
  return refused;
}

/** Has the browser save a file. */
export function save(name: string, pieces: BlobPart[], type: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob(pieces, { type }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
