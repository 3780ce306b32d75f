// The console's rule: every line gets exactly one answer, `ok ...` or `err ...`; lines that begin
// with # come before it, or unasked. One line is sent at a time.
import type { Link } from './link';

/** What the firmware's first line begins with. */
export const GREETING = '# lizard ';
/** The console takes lines of at most so many characters. */
export const LONGEST_LINE = 63;
/** The robot's own lines are shorter than this: what is longer is noise, and is cut. */
const LONGEST = 500;
/** No answer within this time, ms, is none. */
const PATIENCE = 3000;

export interface Answer {
  ok: boolean;
  /** The line itself. */
  text: string;
  /** The # lines that came before it. */
  notes: string[];
}

export interface Heard {
  /** A line that was sent. */
  sent(line: string): void;
  /** A line that came. */
  came(line: string): void;
}

/** What was asked is of no interest any more. */
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
    private readonly heard: Heard,
  ) {
    link.onBytes = (bytes) => this.bytes(bytes);
  }

  /** Sends a line and waits for its answer, `patience` ms. A quiet one is not shown. */
  ask(line: string, quiet = false, patience = PATIENCE): Promise<Answer> {
    return new Promise((answered, failed) => {
      if (this.over) throw new Error(`"${line}" was not sent: the boot loader has the line`);
      this.waiting.push({ line, quiet, patience, answered, failed });
      void this.next();
    });
  }

  /** Forgets what was asked: the board begins anew, or the line serves another purpose. */
  forget(): void {
    const questions = [...(this.asked ? [this.asked] : []), ...this.waiting];
    this.asked = null;
    this.waiting.length = 0;
    this.text = '';
    this.notes = [];
    for (const { failed } of questions) failed(new Forgotten());
  }

  /** Ends it; the link may then have another listener. */
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
    if (!question.quiet) this.heard.sent(question.line);
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

  private line(heard: string): void {
    // A reset cuts off what the board was saying, an answer perhaps, and its first line follows on that.
    const line = heard.slice(Math.max(0, heard.indexOf(GREETING)));
    const question = this.asked;
    const answers = /^(ok|err)\b/.test(line);
    if (!(question?.quiet && answers)) this.heard.came(line);
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
