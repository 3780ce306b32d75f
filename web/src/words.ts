// The console words that the page sends or receives. They must be in the core's list, in
// crates/core/src/console/word.rs: when the page starts, it reports each word that is missing from the list.

const WORD_LIST = [
  'stop', 'rest', 'help', 'status', 'pose', 'speed', 'watch', 'trim', 'limit', 'dir', 'scale', 'cal', 'center', 'save',
  'load', 'factory', 'boot', 'deadman',
] as const;

type Word = (typeof WORD_LIST)[number];

export const WORDS = Object.fromEntries(WORD_LIST.map((word) => [word, word])) as { readonly [Name in Word]: Name };

/** The gait that every robot has. */
export const STAND = 'stand';

/** The line that the robot sends at the end of a routine, or of a gait with a count. */
export const DONE_LINE = '# done';

/** The line that the robot sends after a reset if no calibration is saved. */
export const NOTHING_SAVED_LINE = '# calibration: none saved';

/** Returns the words of the page and its buttons that are missing from the core's list. */
export function findUnknownWords(buttons: string[], coreWords: string[]): string[] {
  return [...new Set([...WORD_LIST, ...buttons])].filter((word) => !coreWords.includes(word));
}
