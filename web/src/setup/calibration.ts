// All that `save` keeps: what the console prints for `cal`, and the lines that set it again.
import { calibration as servosOf, type ServoSettings } from '../status';
import { WORDS } from '../words';
import type { Four } from '../robot';

export interface Calibration {
  /** What is done after power-on: a gait, or rest. */
  boot: string;
  /** Milliseconds without a line after which a gait ends; 0 for never. */
  deadman: number;
  servos: Four<ServoSettings>;
}

/** Reads the lines of `cal`; null if one is missing. Other lines among them are skipped. */
export function calibrationOf(lines: string[]): Calibration | null {
  const after = (word: string) => lines.find((line) => line.startsWith(`# ${word} `))?.slice(word.length + 3);
  const [boot, deadman, servos] = [after(WORDS.boot), Number(after(WORDS.deadman)), servosOf(lines)];
  if (!boot || !Number.isFinite(deadman) || !servos) return null;
  return { boot, deadman, servos: servos as Four<ServoSettings> };
}

/** The lines that set all of it. */
export function linesOf({ boot, deadman, servos }: Calibration): string[] {
  const each = servos.flatMap(({ trim, limit: [from, to], dir, scale }, place) => [
    `${WORDS.dir} ${place + 1} ${dir}`,
    `${WORDS.scale} ${place + 1} ${scale.toFixed(2)}`,
    `${WORDS.trim} ${place + 1} ${trim.toFixed(2)}`,
    `${WORDS.limit} ${place + 1} ${from.toFixed(2)} ${to.toFixed(2)}`,
  ]);
  return [...each, `${WORDS.boot} ${boot}`, `${WORDS.deadman} ${deadman}`];
}

/** An angle from 0 up to a turn, in the hundredths that the console has, deg. */
export function angle(degrees: number): number {
  return (((Math.round(degrees * 100) % 36_000) + 36_000) % 36_000) / 100;
}

/** Whether a robot would print the same for both: angles are the same after a whole turn. */
export function isSame(a: Calibration, b: Calibration): boolean {
  const text = ({ boot, deadman, servos }: Calibration) =>
    linesOf({ boot, deadman, servos: servos.map((servo) => ({ ...servo, limit: servo.limit.map(angle) })) as Four<ServoSettings> });
  return text(a).join() === text(b).join();
}

export function copyOf(set: Calibration): Calibration {
  return structuredClone(set);
}
