// The robot's activity, a gait or a command, as the console's lines name it. The name of a gait or a routine
// is also the command that starts it.
import type { Description } from './robot';
import { DONE_LINE, STAND, WORDS } from './words';

const BOOT_PREFIX = '# boot: ';

/** Converts a gait's name, for example `arc-left`, to an activity, `arc left`. */
export const formatActivity = (name: string) => name.replaceAll('-', ' ');

const removeCount = (line: string) => line.replace(/ \d+$/, '');

/** Returns the activity that starts with a line from the robot; null if none starts. */
export function parseActivity(line: string, { gaits, routines }: Description): string | null {
  if (line.startsWith(BOOT_PREFIX)) return formatActivity(line.slice(BOOT_PREFIX.length));
  if (line.startsWith('# fault') || line === DONE_LINE) return WORDS.stop;
  const command = /^ok (.+)$/.exec(line)?.[1] ?? '';
  if (command.startsWith(`${WORDS.pose} `)) return WORDS.pose;
  const activities = [...gaits.map(({ command }) => command), ...routines, WORDS.stop, WORDS.rest, WORDS.center];
  return [command, removeCount(command)].find((activity) => activities.includes(activity)) ?? null;
}

/** Returns true if the robot walks after this line. */
export function startsWalking(line: string, { gaits }: Description): boolean {
  const [word] = line.split(' ');
  // A board with another robot may have gaits that the page's robot does not have.
  const knownGait = gaits.find(({ command }) => command === removeCount(line));
  return knownGait ? knownGait.moves : !['', '?', STAND, ...Object.values<string>(WORDS)].includes(word);
}

/** Returns true if an activity is a routine, also a real board's routine that the page's robot does not have. */
export const isRoutine = (activity: string, description: Description) =>
  startsWalking(activity, description) && !description.gaits.some(({ command }) => command === activity);
