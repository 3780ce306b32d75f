// The serial link: one interface, and at its other end a simulated UNO or a board on USB.

export interface Link {
  /** What is at the other end, for people. */
  readonly name: string;
  /** Whether its USB chip is one that an Arduino Nano may have, too. */
  readonly mayBeNano?: boolean;
  /** Called with the bytes that come. */
  onBytes: (bytes: Uint8Array) => void;
  /** Called when the other end is gone. */
  onGone: (why: string) => void;
  /** Sends bytes. */
  write(bytes: Uint8Array): Promise<void>;
  /** Resets the board, as opening a port does. */
  reset(): Promise<void>;
  /** Waits, in the time of the other end. */
  wait(ms: number): Promise<void>;
  close(): Promise<void>;
}

/** A link whose other end has to be run. */
export interface Simulated extends Link {
  /** Lets time pass. */
  advance(ms: number): void;
  /** The voltage of the board's supply. */
  supply(volts: number): void;
}

/** Waits of a simulated end: they end when its own time has come. */
export class Waits {
  private waiting: { due: number; done: () => void }[] = [];

  until(due: number): Promise<void> {
    return new Promise((done) => this.waiting.push({ due, done }));
  }

  at(now: number): void {
    const over = this.waiting.filter(({ due }) => due <= now);
    if (over.length === 0) return;
    this.waiting = this.waiting.filter(({ due }) => due > now);
    for (const { done } of over) done();
  }
}
