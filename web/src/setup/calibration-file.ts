// A calibration as a file: the TOML of `lizard calibrate backup`, which `lizard calibrate restore` takes as well.
import type { Four } from '../robot';
import type { ServoSettings } from '../status';
import type { Calibration } from './calibration';

/** The value of the key `format`, as `lizard calibrate backup` writes it. */
const FORMAT = 'lizard calibration 1';
const HEAD = `# A lizard's calibration. \`lizard calibrate restore\` gives it back to the robot.
# Angles in degrees; trim and limit as the console has them, scale in us per degree.
`;
const NAMES = ['A1', 'A2', 'A3', 'A4'];
/** Allowed gait names: the name is sent to the robot, so it must not contain a second line. */
const NAME = /^[A-Za-z0-9 _-]{1,48}$/;

/** Writes the text of the file. */
export function fileOf({ boot, deadman, servos }: Calibration): string {
  // `lizard calibrate restore` expects a float.
  const float = (value: number) => (Number.isInteger(value) ? value.toFixed(1) : String(value));
  const tables = servos.map(({ trim, limit, dir, scale }, place) =>
    [
      `[servo.${NAMES[place]}]`,
      `trim = ${float(trim)}`,
      `limit = [${limit.map(float).join(', ')}]`,
      `dir = "${dir}"`,
      `scale = ${float(scale)}`,
      '',
    ].join('\n'),
  );
  return [HEAD, `format = "${FORMAT}"`, `boot = "${boot}"`, `deadman = ${deadman}`, '', ...tables].join('\n');
}

/** Reads the text of such a file. Throws an error that names the line or the key. */
export async function calibrationIn(text: string): Promise<Calibration> {
  // Loaded when a file is opened, which is rare.
  const { parse, TomlError } = await import('smol-toml');
  let table: Record<string, unknown>;
  try {
    table = parse(text);
  } catch (error) {
    if (error instanceof TomlError) throw new Error(`line ${error.line}: this is not TOML`);
    throw error;
  }
  if (table.format !== FORMAT) throw new Error(`the key format = "${FORMAT}" is missing: this is not a calibration`);
  const { boot, deadman } = table;
  if (typeof boot !== 'string' || !NAME.test(boot)) throw new Error(`boot: ${JSON.stringify(boot)} is not the name of a gait`);
  if (typeof deadman !== 'number' || !Number.isInteger(deadman) || deadman < 0 || deadman > 60_000) {
    throw new Error(`deadman: ${JSON.stringify(deadman)} is no whole number from 0 to 60000`);
  }
  const servos = NAMES.map((name) => servoIn(name, (table.servo as Record<string, unknown> | undefined)?.[name]));
  return { boot, deadman, servos: servos as Four<ServoSettings> };
}

function servoIn(name: string, value: unknown): ServoSettings {
  if (typeof value !== 'object' || value === null) throw new Error(`the table servo.${name} is missing`);
  const servo = value as Record<string, unknown>;
  const number = (key: string, given: unknown): number => {
    // The console accepts hundredths, up to a turn.
    const hundredths = Number(given) * 100;
    const isGood = typeof given === 'number' && Math.abs(given) <= 360 && Math.abs(hundredths - Math.round(hundredths)) < 1e-6;
    if (!isGood) throw new Error(`servo.${name}.${key}: ${JSON.stringify(given)} is not a number of at most two decimals, -360..360`);
    return given as number;
  };
  const { limit, dir } = servo;
  if (!Array.isArray(limit) || limit.length !== 2) throw new Error(`servo.${name}.limit: two angles are wanted`);
  if (dir !== '+' && dir !== '-') throw new Error(`servo.${name}.dir: "+" or "-" is wanted`);
  const ends: [number, number] = [number('limit', limit[0]), number('limit', limit[1])];
  return { trim: number('trim', servo.trim), limit: ends, dir, scale: number('scale', servo.scale) };
}
