// The console's rule: every line gets exactly one answer, in order, `ok ...` or `err ...`; lines that begin
// with # come before the answer, or unasked. One line is sent at a time, except `stop`: it is sent at once, and
// repeated until the robot answers it, since a link may lose a line or its answer.
import { WORDS } from '../words';
import type { Link } from './link';

/** The beginning of the firmware's banner, its first line after a reset. */
export const GREETING = '# lizard ';
/** The largest length of a line of the robot; longer lines are noise and are cut. */
const MAX_LINE_LENGTH = 500;
/** Time within which an answer must come, ms. */
const TIMEOUT_MS = 3000;
/** Time from one `stop` to its repetition while none is answered, ms. */
const STOP_INTERVAL_MS = 250;
/** Time after the first answer to a repeated `stop` within which the answers to its repetitions have come, ms. */
const LATE_STOP_ANSWERS_MS = 500;
/** Time without an expected answer after which a robot counts as silent, ms. */
export const SILENCE = 800;
/** The texts that a Bluetooth module inserts into the line when its link begins and ends. */
const MODULE_TEXTS = /OK\+(CONN|LOST)/g;
/**
 * The refusals of `stop` by a board without pulses, because it rests or has no robot in its flash. The whole line
 * must match: a line that a radio has cut off may be the beginning of an older answer.
 */
const CANNOT_MOVE = /^err (7 servos are resting, send stand first|10 no robot in the flash)$/;
/** A # line with a setting, which `cal` prints before its answer. */
const SETTING = /^# (A[1-4]|boot|deadman) /;

export interface Answer {
  ok: boolean;
  /** The answer's line. */
  text: string;
  /** The # lines before the answer. */
  notes: string[];
}

export interface DialogueListener {
  /** Called with each line that is sent. */
  sent(line: string): void;
  /** Called with each line that is received and is to be shown. */
  received(line: string): void;
  /** Called with each line that the robot sends, also with lines that are not shown. */
  arrived(line: string): void;
  /** Called when the robot has left a line unanswered for `SILENCE`, and when it answers again. */
  silent(isSilent: boolean): void;
  /** Called when `stop` begins to be sent, and when the robot has answered it. */
  stopping(isStopping: boolean): void;
}

/** Thrown for a question that was dropped before its answer. */
export class DroppedQuestion extends Error {}

interface PromiseCallbacks {
  answered: (answer: Answer) => void;
  failed: (error: Error) => void;
}

interface Question extends PromiseCallbacks {
  line: string;
  quiet: boolean;
  timeout: number;
}

/** A `stop` that has no answer yet: the callbacks of its callers, and how often it was sent. */
interface Stop {
  ends: PromiseCallbacks[];
  times: number;
}

const wordOf = (line: string) => line.trim().toLowerCase().split(/\s/)[0];

/**
 * True if a line that begins with `ok` or `err` can be the answer to `line`, and not a late answer to another line.
 */
function isAnswerTo(answer: string, line: string): boolean {
  const word = wordOf(line);
  const expected = { [WORDS.status]: 'gait=', '?': WORDS.help }[word] ?? word;
  return answer.startsWith('err') || answer.startsWith(`ok ${expected}`);
}

export class Dialogue {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder('latin1');
  private text = '';
  private readonly waiting: Question[] = [];
  private pending: Question | null = null;
  private stop: Stop | null = null;
  /** Pending while answers to repetitions of `stop` may still come; no other line is sent meanwhile. */
  private echoes: Promise<void> | null = null;
  private isSilent = false;
  /** The line that is sent at intervals, in addition to all others; null for none. */
  private repeated: { line: string } | null = null;
  /** The expected answer to the repeated line. */
  private repeatedAnswer = '';
  private notes: string[] = [];
  /** True once the dialogue has ended: something else uses the link, such as the boot loader. */
  isClosed = false;

  constructor(
    readonly link: Link,
    private readonly listener: DialogueListener,
  ) {
    link.onBytes = (bytes) => this.receiveBytes(bytes);
  }

  /**
   * Sends a line and waits at most `timeout` ms for its answer. `stop` is sent at once, and its answer is awaited
   * without a limit. A quiet line is not shown in the console.
   */
  ask(line: string, quiet = false, timeout = TIMEOUT_MS): Promise<Answer> {
    return new Promise((answered, failed) => {
      if (this.isClosed) throw new Error(`"${line}" was not sent: the boot loader has the line`);
      if (line.trim().toLowerCase() === WORDS.stop) return this.halt({ answered, failed });
      this.waiting.push({ line, quiet, timeout, answered, failed });
      void this.sendNext();
    });
  }

  /** Drops all questions: the board restarts, or something else uses the link. */
  forget(): void {
    const dropped = [...(this.pending ? [this.pending] : []), ...(this.stop?.ends ?? [])];
    this.pending = null;
    this.text = '';
    this.notes = [];
    if (this.stop) this.listener.stopping(false);
    this.stop = null;
    this.setHeard();
    for (const { failed } of dropped) failed(new DroppedQuestion());
    this.forgetWaiting();
  }

  private forgetWaiting(): void {
    for (const { failed } of this.waiting.splice(0)) failed(new DroppedQuestion());
  }

  /** Stops the robot. Waiting lines are dropped, since they could make it walk on. */
  private halt(ends: PromiseCallbacks): void {
    this.forgetWaiting();
    if (this.stop) {
      this.stop.ends.push(ends);
      return;
    }
    const stop = (this.stop = { ends: [ends], times: 0 });
    this.listener.sent(WORDS.stop);
    this.listener.stopping(true);
    void this.repeatStop(stop);
    void this.link.wait(SILENCE).then(() => this.stop === stop && this.setHeard(false));
  }

  private async repeatStop(stop: Stop): Promise<void> {
    while (this.stop === stop) {
      stop.times += 1;
      // The link itself reports a port that accepts no more bytes.
      this.link.write(this.encoder.encode(`${WORDS.stop}\n`)).catch(() => {});
      await this.link.wait(STOP_INTERVAL_MS);
    }
  }

  /**
   * Sends a line every `intervalMs` ms, in addition to all others and without waiting for its answer; null ends the
   * repetition.
   */
  keepAlive(line: string | null, intervalMs = 0): void {
    const repeated = (this.repeated = line === null ? null : { line });
    if (!repeated) return;
    this.repeatedAnswer = `ok ${repeated.line}`;
    const repeatLine = async () => {
      while (this.repeated === repeated && !this.isClosed) {
        this.link.write(this.encoder.encode(`${repeated.line}\n`)).catch(() => {});
        await this.link.wait(intervalMs);
      }
    };
    void repeatLine();
  }

  private finishStop(stop: Stop, answer: Answer): void {
    this.stop = null;
    this.listener.stopping(false);
    this.setHeard();
    // Answers come in order, so the answer to the line sent before `stop` has been lost.
    const { pending: question } = this;
    this.pending = null;
    question?.failed(new DroppedQuestion());
    for (const { answered } of stop.ends) answered(answer);
    const echoes = (this.echoes = stop.times > 1 ? this.link.wait(LATE_STOP_ANSWERS_MS) : null);
    void echoes?.then(() => {
      if (this.echoes === echoes) this.echoes = null;
      void this.sendNext();
    });
    void this.sendNext();
  }

  private setHeard(isHeard = true): void {
    if (this.isSilent === !isHeard) return;
    this.isSilent = !isHeard;
    this.listener.silent(!isHeard);
  }

  /** Ends the dialogue; the link may then have another listener. */
  end(): void {
    this.isClosed = true;
    this.forget();
  }

  private async sendNext(): Promise<void> {
    if (this.pending || this.stop || this.echoes || this.isClosed) return;
    const question = this.waiting.shift();
    if (!question) return;
    this.pending = question;
    this.notes = [];
    if (!question.quiet) this.listener.sent(question.line);
    try {
      await this.link.write(this.encoder.encode(`${question.line}\n`));
      void this.link.wait(SILENCE).then(() => this.pending === question && this.setHeard(false));
      await this.link.wait(question.timeout);
      if (this.pending === question) throw new Error(`no answer to "${question.line}"`);
    } catch (error) {
      if (this.pending !== question) return;
      this.pending = null;
      question.failed(error instanceof Error ? error : new Error(String(error)));
      void this.sendNext();
    }
  }

  private receiveBytes(bytes: Uint8Array): void {
    if (this.isClosed) return;
    this.text += this.decoder.decode(bytes);
    const lines = this.text.split(/\r?\n/);
    this.text = (lines.pop() ?? '').slice(-MAX_LINE_LENGTH);
    for (const line of lines) if (line !== '') this.receiveLine(line.slice(-MAX_LINE_LENGTH));
  }

  private receiveLine(received: string): void {
    // A reset cuts off the line that the board is sending, and the banner follows on the same line.
    const line = received.slice(Math.max(0, received.indexOf(GREETING))).replace(MODULE_TEXTS, '');
    if (line === '') return;
    this.listener.arrived(line);
    const { pending: question, stop } = this;
    const isAnswer = /^(ok|err)\b/.test(line);
    if (!isAnswer) {
      // The settings that the page asks for by itself are not shown.
      if (!(question?.quiet && wordOf(question.line) === WORDS.cal && SETTING.test(line))) this.listener.received(line);
      this.notes.push(line);
      return;
    }
    if (line === `ok ${WORDS.stop}` || (stop && CANNOT_MOVE.test(line))) {
      if (!stop) return;
      this.listener.received(line);
      this.finishStop(stop, { ok: line.startsWith('ok'), text: line, notes: [] });
      return;
    }
    const isExpected = question !== null && isAnswerTo(line, question.line);
    const isQuiet = isExpected ? question.quiet : line === this.repeatedAnswer;
    if (!isQuiet) this.listener.received(line);
    if (!isExpected) return;
    this.pending = null;
    this.setHeard();
    const { notes } = this;
    this.notes = [];
    question.answered({ ok: line.startsWith('ok'), text: line, notes });
    void this.sendNext();
  }
}
