// Writes the firmware, the robot or both to a board, and shows the progress and the result in the caller's elements,
// whose ids are `PREFIX-progress` and `PREFIX-message`.
import { signal } from '@preact/signals-core';

import type { ReportProgress } from '../board-program';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { element, setText } from './elements';

/** The content to write: the page's robot alone, firmware and robot, or the image of a chosen file. */
export type WriteContent = 'robot' | 'all' | Uint8Array;

const NO_BOARD_MESSAGE = 'No board is connected. Press “Connect a board…” in the room Board. The simulated board already has this robot.';

/** The message of each step, and the progress bar's percentages at its start and its end. */
const PROGRESS_STEPS = {
  retrying: ['no answer; calling the boot loader again…', 0, 0],
  reading: ['reading the board…', 0, 25],
  writing: ['writing…', 25, 75],
  verifying: ['verifying…', 75, 100],
} as const;

export class BoardWriter {
  /** True while the boot loader uses the link. */
  readonly isBusy = signal(false);

  constructor(private readonly session: Session) {}

  /** Writes the page's robot alone to a real board; returns true if the board then reports this robot. */
  async writeRobot(prefix: string): Promise<boolean> {
    if (this.session.board.isReal) return this.write('robot', prefix);
    element(`${prefix}-message`).textContent = NO_BOARD_MESSAGE;
    return false;
  }

  /**
   * Writes and verifies, then waits for the board's banner; returns false if a step fails, if no banner arrives or,
   * unless the content is a file's image, if the banner does not name the page's robot.
   */
  async write(content: WriteContent, prefix: string): Promise<boolean> {
    if (this.isBusy.value) return false;
    const progress = element<HTMLProgressElement>(`${prefix}-progress`);
    const message = element(`${prefix}-message`);
    const { session } = this;
    // The name tells the user that the simulated board was written to, not a real board.
    const targetText = session.board.isReal ? '' : ` to the ${session.board.link.name}`;
    const start = performance.now();
    const hash = typeof content === 'string' ? session.robot.description.hash : null;
    this.isBusy.value = true;
    progress.hidden = false;
    progress.value = 0;
    message.textContent = 'calling the boot loader…';
    let isWritten = false;
    const showProgress: ReportProgress = (step, done, total) => {
      const [text, from, to] = PROGRESS_STEPS[step];
      // Within an attempt, the bar never moves back, although the first page is written after the others are verified.
      progress.value = step === 'retrying' ? 0 : Math.max(progress.value, from + ((to - from) * done) / total);
      setText(message, text);
    };
    try {
      await (content === 'robot' ? session.program.write(session.robot.section, true, showProgress) : session.program.write(content === 'all' ? session.robot.image : content, false, showProgress));
      isWritten = true;
      message.textContent = `written${targetText} and verified in ${formatSeconds(performance.now() - start)}`;
    } catch (error) {
      message.textContent = `not written: ${getMessage(error)}`;
    }
    progress.hidden = true;
    this.isBusy.value = false;
    if (!isWritten) return false;
    const problem = await session.program.checkWritten(hash);
    if (problem === null) return true;
    message.textContent = `written and verified; ${problem}`;
    return false;
  }
}

/** Formats a time in seconds, with a decimal below 9.5 s. */
const formatSeconds = (ms: number) => `${(ms / 1000).toFixed(ms < 9500 ? 1 : 0)} s`;
