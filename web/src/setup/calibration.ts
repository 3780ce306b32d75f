// The settings that `save` stores: read from the lines of `cal`, and written as the lines that set them.
import { calibration as servosOf, type ServoSettings } from '../status';
import { WORDS } from '../words';
import type { Four } from '../robot';

export interface Calibration {
  /** The action after power-on: a gait, or rest. */
  boot: string;
  /** Time without a line after which a gait ends, ms; 0 for never. */
  deadman: number;
  servos: Four<ServoSettings>;
}

/** Reads the lines of `cal`, skipping others; null if one is missing. */
export function calibrationOf(lines: string[]): Calibration | null {
  const after = (word: string) => lines.find((line) => line.startsWith(`# ${word} `))?.slice(word.length + 3);
  const [boot, deadman, servos] = [after(WORDS.boot), Number(after(WORDS.deadman)), servosOf(lines)];
  if (!boot || !Number.isFinite(deadman) || !servos) return null;
  return { boot, deadman, servos: servos as Four<ServoSettings> };
}

/** The console lines that set a calibration. */
export function linesOf({ boot, deadman, servos }: Calibration): string[] {
  const each = servos.flatMap(({ trim, limit: [from, to], dir, scale }, place) => [
    `${WORDS.dir} ${place + 1} ${dir}`,
    `${WORDS.scale} ${place + 1} ${scale.toFixed(2)}`,
    `${WORDS.trim} ${place + 1} ${trim.toFixed(2)}`,
    `${WORDS.limit} ${place + 1} ${from.toFixed(2)} ${to.toFixed(2)}`,
  ]);
  return [...each, `${WORDS.boot} ${boot}`, `${WORDS.deadman} ${deadman}`];
}

/** Wraps an angle to 0 up to a turn, rounded to the console's hundredths, deg. */
export function angle(degrees: number): number {
  return (((Math.round(degrees * 100) % 36_000) + 36_000) % 36_000) / 100;
}

/** Returns true if a robot would print the same for both; angles may differ by a turn. */
export function isSame(a: Calibration, b: Calibration): boolean {
  const text = ({ boot, deadman, servos }: Calibration) =>
    linesOf({ boot, deadman, servos: servos.map((servo) => ({ ...servo, limit: servo.limit.map(angle) })) as Four<ServoSettings> });
  return text(a).join() === text(b).join();
}

export function copyOf(set: Calibration): Calibration {
  return structuredClone(set);
}
