// Reads the banner, the answer to `status` and `# t=` lines.
import type { Four } from './robot';

/** The firmware's first line after a reset. */
export interface Banner {
  version: string;
  /** The robot in its flash; null if there is none or it is damaged. */
  robot: { name: string; hash: string } | null;
}

/** Reads a banner; null for any other line, also for the banner of an old firmware that had its robot compiled in. */
export function parseBanner(line: string): Banner | null {
  const [, version, name, hash] = /^# lizard (\S+) (?:robot (\S+) ([0-9a-f]{8})|without a robot),/.exec(line) ?? [];
  if (version === undefined) return null;
  return { version, robot: name === undefined || hash === undefined ? null : { name, hash } };
}

/** The answer to `status`. */
export interface Status {
  /** The robot's activity: a gait or a command, with hyphens for spaces. */
  gait: string;
  /** Pose, deg; null without a robot in the flash. */
  pose: Four<number> | null;
  /** Phase of the gait's cycle, 0 to 1; 0 while no gait runs. */
  phase: number;
  /** Frames since the reset. */
  frames: number;
  /** Smallest margin; null without a robot in the flash. */
  margin: number | null;
  /** `clear`, or `held` after an unsafe pose. */
  guard: string;
  fault: string;
  /** Number of late edges of pulses. */
  lateEdges: number;
  /** Number of lost bytes. */
  lostBytes: number;
  /** Cause of the last start. */
  resetCause: string;
  /** Number of resets since power-on. */
  resetCount: number;
  /** Voltage of the board, V; null until it is measured. */
  vcc: number | null;
  /** Pace, percent; null for a firmware that does not report it. */
  speed: number | null;
}

function parseFourNumbers(text: string | undefined): Four<number> | null {
  const numbers = (text ?? '').split(',').map(Number);
  return numbers.length === 4 && numbers.every(Number.isFinite) ? (numbers as Four<number>) : null;
}

/** Reads an answer `ok gait=...`; null for any other line. */
export function parseStatus(line: string): Status | null {
  if (!line.startsWith('ok gait=')) return null;
  const pairs = new Map(line.slice(3).split(' ').map((pair) => pair.split('=') as [string, string]));
  const pose = parseFourNumbers(pairs.get('pose'));
  if (!pose && pairs.get('fault') !== 'robot') return null;
  const numberOf = (key: string): number | null => (pairs.has(key) ? parseFloat(pairs.get(key)!) : null);
  return {
    gait: pairs.get('gait') ?? '',
    pose,
    phase: numberOf('phase') ?? 0,
    frames: numberOf('frames') ?? 0,
    margin: numberOf('margin'),
    guard: pairs.get('guard') ?? '',
    fault: pairs.get('fault') ?? 'none',
    lateEdges: numberOf('late') ?? 0,
    lostBytes: numberOf('rx_lost') ?? 0,
    resetCause: pairs.get('reset') ?? '',
    resetCount: numberOf('resets') ?? 0,
    vcc: numberOf('vcc'),
    speed: numberOf('speed'),
  };
}

/** Reads the pose of a line `# t=<frame> pose=...`. */
export function parseReportedPose(line: string): Four<number> | null {
  const match = /^# t=\d+ pose=(\S+)/.exec(line);
  return match ? parseFourNumbers(match[1]) : null;
}
