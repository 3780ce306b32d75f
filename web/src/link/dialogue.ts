// The dialogue with the robot's console. Every line gets exactly one answer, in order: `ok ...` or `err ...`. Lines
// that begin with # precede the answer or are unsolicited. One line is sent at a time, except `stop`: it is sent at
// once and repeated until the robot answers, because a link may lose a line or its answer.
import { WORDS } from '../words';
import type { Link } from './link';

/** The beginning of the firmware's banner, which is its first line after a reset. */
export const BANNER_PREFIX = '# lizard ';
/** Largest length of a line from the robot, characters; a longer line is noise and loses its beginning. */
const MAX_LINE_LENGTH = 500;
/** Longest wait for an answer, ms. */
const ANSWER_TIMEOUT_MS = 3000;
/** Interval between repetitions of an unanswered `stop`, ms. */
const STOP_INTERVAL_MS = 250;
/** Longest time between the first answer to a repeated `stop` and the answers to the repetitions, ms. */
const LATE_STOP_ANSWERS_MS = 500;
/** Time without an expected answer after which the robot counts as silent, ms. */
export const SILENCE_MS = 800;
/** Messages that a Bluetooth module inserts into the line when it connects and disconnects. */
const BLUETOOTH_MODULE_MESSAGES = /OK\+(CONN|LOST)/g;
/**
 * A refusal of `stop` by a board that sends no pulses because it rests or has no robot in its flash. The whole line
 * must match: a line that a radio truncated may be the beginning of an earlier answer.
 */
const STOP_REFUSAL = /^err (7 the servos are resting; send stand first|10 no robot in the flash)$/;
/** A # line with a setting, which the robot sends before the answer to `cal`. */
const SETTING_LINE = /^# (A[1-4]|boot|deadman) /;

export interface Answer {
  ok: boolean;
  /** The line of the answer. */
  text: string;
  /** The # lines before the answer. */
  notes: string[];
}

export interface DialogueListener {
  /** Called with each visible sent line. */
  onSent(line: string): void;
  /** Called with each visible received line. */
  onShownLine(line: string): void;
  /** Called with each received line, visible or not. */
  onAnyLine(line: string): void;
  /** Called when a line has been unanswered for `SILENCE_MS`, and when the robot answers again. */
  onSilent(isSilent: boolean): void;
  /** Called when `stop` is sent for the first time, and when the robot answers it. */
  onStopping(isStopping: boolean): void;
}

/** Thrown for a request that is dropped before its answer arrives. */
export class DroppedRequest extends Error {}

interface PromiseCallbacks {
  resolve: (answer: Answer) => void;
  reject: (error: Error) => void;
}

interface Request extends PromiseCallbacks {
  line: string;
  isQuiet: boolean;
  timeoutMs: number;
}

/** An unanswered `stop`: the callbacks of its callers, and the number of times that it was sent. */
interface PendingStop {
  callers: PromiseCallbacks[];
  sendCount: number;
}

const getFirstWord = (line: string) => line.trim().toLowerCase().split(/\s/)[0];

/** Returns true if an answer can belong to `line`, and is not a late answer to another line. */
function canAnswer(answer: string, line: string): boolean {
  const word = getFirstWord(line);
  // The robot also answers each repetition of `deadman`, which has another value.
  if (word === WORDS.deadman && answer.startsWith('ok')) return answer === `ok ${line.trim().toLowerCase()}`;
  const expected = { [WORDS.status]: 'gait=', '?': WORDS.help }[word] ?? word;
  return answer.startsWith('err') || answer.startsWith(`ok ${expected}`);
}

export class Dialogue {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder('latin1');
  /** The received part of the incomplete line. */
  private partialLine = '';
  private readonly queuedRequests: Request[] = [];
  private pendingRequest: Request | null = null;
  private pendingStop: PendingStop | null = null;
  /** Pending while answers to repetitions of `stop` may arrive; no other line is sent meanwhile. */
  private lateAnswerPeriod: Promise<void> | null = null;
  /** True while a line has had no answer for `SILENCE_MS`. */
  isSilent = false;
  /**
   * The line that is repeated independently of other lines; null for none. An object, so that a new repetition of the
   * same line differs from the previous one.
   */
  private keepAliveLine: { line: string } | null = null;
  /** The expected answer to the repeated line; it is not shown. */
  private keepAliveAnswer = '';
  /** The # lines since the last request. */
  private notes: string[] = [];
  /** True once the dialogue is closed; another user of the link, such as the boot loader, may then take over. */
  isClosed = false;

  constructor(
    readonly link: Link,
    private readonly listener: DialogueListener,
  ) {
    link.onBytes = (bytes) => this.receiveBytes(bytes);
  }

  /**
   * Sends a line and waits at most `timeoutMs` for its answer. Sends `stop` at once, and waits for its answer without a
   * time limit. A quiet line and its answer are not shown.
   */
  ask(line: string, isQuiet = false, timeoutMs = ANSWER_TIMEOUT_MS): Promise<Answer> {
    return new Promise((resolve, reject) => {
      if (this.isClosed) throw new Error(`"${line}" was not sent: the boot loader is using the serial line`);
      if (line.trim().toLowerCase() === WORDS.stop) return this.sendStop({ resolve, reject });
      this.queuedRequests.push({ line, isQuiet, timeoutMs, resolve, reject });
      void this.sendNext();
    });
  }

  /** Drops all requests: the board restarts, or another user takes over the link. */
  dropRequests(): void {
    const { pendingStop: stop } = this;
    this.partialLine = '';
    this.notes = [];
    if (stop) this.listener.onStopping(false);
    this.pendingStop = null;
    this.setSilent(false);
    for (const { reject } of stop?.callers ?? []) reject(new DroppedRequest());
    this.dropPendingRequest();
    this.dropQueuedRequests();
  }

  private dropPendingRequest(): void {
    const { pendingRequest: request } = this;
    this.pendingRequest = null;
    request?.reject(new DroppedRequest());
  }

  private dropQueuedRequests(isKept: (request: Request) => boolean = () => false): void {
    for (const request of this.queuedRequests.splice(0)) {
      if (isKept(request)) this.queuedRequests.push(request);
      else request.reject(new DroppedRequest());
    }
  }

  /** Sends `stop`, and drops the queued lines, which could make the robot walk again; a pace cannot. */
  private sendStop(callbacks: PromiseCallbacks): void {
    this.dropQueuedRequests(({ line }) => getFirstWord(line) === WORDS.speed);
    if (this.pendingStop) return void this.pendingStop.callers.push(callbacks);
    const stop = (this.pendingStop = { callers: [callbacks], sendCount: 0 });
    this.listener.onSent(WORDS.stop);
    this.listener.onStopping(true);
    void this.repeatStop(stop);
    void this.link.wait(SILENCE_MS).then(() => this.pendingStop === stop && this.setSilent(true));
  }

  private async repeatStop(stop: PendingStop): Promise<void> {
    while (this.pendingStop === stop) {
      stop.sendCount += 1;
      // A lost port is ignored here, because the link reports it.
      this.link.write(this.encoder.encode(`${WORDS.stop}\n`)).catch(() => {});
      await this.link.wait(STOP_INTERVAL_MS);
    }
  }

  /** Sends a line every `intervalMs`, independently of other lines and without waiting for answers. Null ends this. */
  keepAlive(line: string | null, intervalMs = 0): void {
    const keepAliveLine = (this.keepAliveLine = line === null ? null : { line });
    if (!keepAliveLine) return;
    this.keepAliveAnswer = `ok ${keepAliveLine.line}`;
    const repeatLine = async () => {
      while (this.keepAliveLine === keepAliveLine && !this.isClosed) {
        this.link.write(this.encoder.encode(`${keepAliveLine.line}\n`)).catch(() => {});
        await this.link.wait(intervalMs);
      }
    };
    void repeatLine();
  }

  private finishStop(stop: PendingStop, answer: Answer): void {
    this.pendingStop = null;
    this.listener.onStopping(false);
    this.setSilent(false);
    // Answers arrive in order; therefore the answer to the line before `stop` was lost.
    this.dropPendingRequest();
    for (const { resolve } of stop.callers) resolve(answer);
    const lateAnswerPeriod = (this.lateAnswerPeriod = stop.sendCount > 1 ? this.link.wait(LATE_STOP_ANSWERS_MS) : null);
    void lateAnswerPeriod?.then(() => {
      if (this.lateAnswerPeriod === lateAnswerPeriod) this.lateAnswerPeriod = null;
      void this.sendNext();
    });
    void this.sendNext();
  }

  private setSilent(isSilent: boolean): void {
    if (this.isSilent === isSilent) return;
    this.isSilent = isSilent;
    this.listener.onSilent(isSilent);
  }

  /** Closes the dialogue and frees the link for another user. */
  close(): void {
    this.isClosed = true;
    this.dropRequests();
  }

  private async sendNext(): Promise<void> {
    if (this.pendingRequest || this.pendingStop || this.lateAnswerPeriod || this.isClosed) return;
    const request = this.queuedRequests.shift();
    if (!request) return;
    this.pendingRequest = request;
    this.notes = [];
    if (!request.isQuiet) this.listener.onSent(request.line);
    try {
      await this.link.write(this.encoder.encode(`${request.line}\n`));
      void this.link.wait(SILENCE_MS).then(() => this.pendingRequest === request && this.setSilent(true));
      await this.link.wait(request.timeoutMs);
      if (this.pendingRequest === request) throw new Error(`no answer to "${request.line}"`);
    } catch (error) {
      if (this.pendingRequest !== request) return;
      this.pendingRequest = null;
      request.reject(error instanceof Error ? error : new Error(String(error)));
      void this.sendNext();
    }
  }

  private receiveBytes(bytes: Uint8Array): void {
    if (this.isClosed) return;
    this.partialLine += this.decoder.decode(bytes);
    const lines = this.partialLine.split(/\r?\n/);
    this.partialLine = (lines.pop() ?? '').slice(-MAX_LINE_LENGTH);
    for (const line of lines) if (line !== '') this.receiveLine(line.slice(-MAX_LINE_LENGTH));
  }

  private receiveLine(received: string): void {
    // A reset truncates the line that the board is sending; the banner follows on the same line.
    const line = received.slice(Math.max(0, received.indexOf(BANNER_PREFIX))).replace(BLUETOOTH_MODULE_MESSAGES, '');
    if (line === '') return;
    this.listener.onAnyLine(line);
    if (line.startsWith(BANNER_PREFIX)) {
      // The robot has restarted: it answers no earlier line, and a waiting line must not make it walk.
      this.dropPendingRequest();
      this.dropQueuedRequests();
      if (!this.pendingStop) this.setSilent(false);
    }
    const { pendingRequest: request, pendingStop: stop } = this;
    const isAnswer = /^(ok|err)\b/.test(line);
    if (!isAnswer) {
      // Settings that the page itself requested are not shown.
      if (!(request?.isQuiet && getFirstWord(request.line) === WORDS.cal && SETTING_LINE.test(line))) this.listener.onShownLine(line);
      this.notes.push(line);
      return;
    }
    if (line === `ok ${WORDS.stop}` || (stop && STOP_REFUSAL.test(line))) {
      if (!stop) return;
      this.listener.onShownLine(line);
      return this.finishStop(stop, { ok: line.startsWith('ok'), text: line, notes: [] });
    }
    const isExpected = request !== null && canAnswer(line, request.line);
    const isQuiet = isExpected ? request.isQuiet : line === this.keepAliveAnswer;
    if (!isQuiet) this.listener.onShownLine(line);
    if (!isExpected) return;
    this.pendingRequest = null;
    this.setSilent(false);
    const { notes } = this;
    this.notes = [];
    request.resolve({ ok: line.startsWith('ok'), text: line, notes });
    void this.sendNext();
  }
}
