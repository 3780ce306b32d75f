// The console's words that the page sends or waits for. They must be in the core's list,
// crates/core/src/console/word.rs: a page with a word that is not in the list reports it when it begins.

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

/** Gaits that the page starts by name: every robot has `stand`, and `walk` is preferred. */
export const GAITS = { stand: 'stand', walk: 'walk' } as const;

/** The line at the end of a gait with a count, and of a routine. */
export const DONE = '# done';

/** The firmware's line after a reset if nothing was ever saved. */
export const NOTHING_SAVED = '# calibration: none is saved';

/** Returns the words of the page and of its buttons that are not among the core's words. */
export function unknownWords(buttons: string[], core: string[]): string[] {
  return [...new Set([...Object.values(WORDS), ...buttons])].filter((word) => !core.includes(word));
}
