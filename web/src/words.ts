// The console words that the page sends or receives. They must be in the core's list, in
// crates/core/src/console/word.rs: when the page starts, it reports each word that is missing from the list.

export const WORDS = {
  stop: 'stop',
  rest: 'rest',
  help: 'help',
  status: 'status',
  pose: 'pose',
  speed: 'speed',
  watch: 'watch',
  trim: 'trim',
  limit: 'limit',
  dir: 'dir',
  scale: 'scale',
  cal: 'cal',
  center: 'center',
  save: 'save',
  load: 'load',
  factory: 'factory',
  boot: 'boot',
  deadman: 'deadman',
} as const;

/** The gaits that the page uses by name: every robot has `stand`, and the page prefers `walk` to other gaits. */
export const GAITS = { stand: 'stand', walk: 'walk' } as const;

/** The line that the robot sends at the end of a routine, or of a gait with a count. */
export const DONE_LINE = '# done';

/** The line that the robot sends after a reset if no calibration is saved. */
export const NOTHING_SAVED_LINE = '# calibration: none saved';

/** Returns the words of the page and its buttons that are missing from the core's list. */
export function findUnknownWords(buttons: string[], coreWords: string[]): string[] {
  return [...new Set([...Object.values(WORDS), ...buttons])].filter((word) => !coreWords.includes(word));
}
