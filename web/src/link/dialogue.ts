// The console's rule: every line gets exactly one answer, `ok ...` or `err ...`; lines that begin
// with # come before it, or unasked. One line is sent at a time.
import type { Link } from './link';

/** The beginning of the firmware's first line. */
export const GREETING = '# lizard ';
/** Most characters of a line that the console accepts. */
export const LONGEST_LINE = 63;
/** The robot's lines are shorter than this; longer ones are noise and are cut. */
const LONGEST = 500;
/** Time within which an answer must come, ms. */
const PATIENCE = 3000;

export interface Answer {
  ok: boolean;
  /** The answer's line. */
  text: string;
  /** The # lines before it. */
  notes: string[];
}

export interface DialogueListener {
  /** Called with each line that is sent. */
  sent(line: string): void;
  /** Called with each line that is received. */
  received(line: string): void;
}

/** Thrown for a question that was dropped before its answer. */
export class Forgotten extends Error {}

interface Question {
  line: string;
  quiet: boolean;
  patience: number;
  answered: (answer: Answer) => void;
  failed: (error: Error) => void;
}

export class Dialogue {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder('latin1');
  private text = '';
  private readonly waiting: Question[] = [];
  private asked: Question | null = null;
  private notes: string[] = [];
  /** Whether the line serves another purpose. */
  over = false;

  constructor(
    readonly link: Link,
    private readonly listener: DialogueListener,
  ) {
    link.onBytes = (bytes) => this.bytes(bytes);
  }

  /** Sends a line and waits at most `patience` ms for its answer. A quiet line is not shown in the console. */
  ask(line: string, quiet = false, patience = PATIENCE): Promise<Answer> {
    return new Promise((answered, failed) => {
      if (this.over) throw new Error(`"${line}" was not sent: the boot loader has the line`);
      this.waiting.push({ line, quiet, patience, answered, failed });
      void this.next();
    });
  }

  /** Drops all questions: the board restarts, or the line is used by something else. */
  forget(): void {
    const questions = [...(this.asked ? [this.asked] : []), ...this.waiting];
    this.asked = null;
    this.waiting.length = 0;
    this.text = '';
    this.notes = [];
    for (const { failed } of questions) failed(new Forgotten());
  }

  /** Ends the dialogue; the link may then have another listener. */
  end(): void {
    this.over = true;
    this.forget();
  }

  private async next(): Promise<void> {
    if (this.asked || this.over) return;
    const question = this.waiting.shift();
    if (!question) return;
    this.asked = question;
    this.notes = [];
    if (!question.quiet) this.listener.sent(question.line);
    try {
      await this.link.write(this.encoder.encode(`${question.line}\n`));
      await this.link.wait(question.patience);
      if (this.asked === question) throw new Error(`no answer to "${question.line}"`);
    } catch (error) {
      if (this.asked !== question) return;
      this.asked = null;
      question.failed(error instanceof Error ? error : new Error(String(error)));
      void this.next();
    }
  }

  private bytes(bytes: Uint8Array): void {
    if (this.over) return;
    this.text += this.decoder.decode(bytes);
    const lines = this.text.split(/\r?\n/);
    this.text = (lines.pop() ?? '').slice(-LONGEST);
    for (const line of lines) if (line !== '') this.line(line.slice(-LONGEST));
  }

  private line(received: string): void {
    // A reset cuts off the board's line, perhaps an answer, and the banner follows on the same line.
    const line = received.slice(Math.max(0, received.indexOf(GREETING)));
    const question = this.asked;
    const answers = /^(ok|err)\b/.test(line);
    if (!(question?.quiet && answers)) this.listener.received(line);
    if (!answers) {
      this.notes.push(line);
    } else if (question) {
      this.asked = null;
      const { notes } = this;
      this.notes = [];
      question.answered({ ok: line.startsWith('ok'), text: line, notes });
      void this.next();
    }
  }
}
