// The serial link to a simulated UNO, or to a board by USB or radio.

/** The baud rate of the firmware, and of every link that is not told another one. */
export const BAUD = 115_200;
/** The message when a board was unplugged. */
export const GONE_MESSAGE = 'the board is not connected any more';

export const sleep = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export interface Link {
  /**
   * By USB a board is reset when its port is opened, and its flash can be written; by radio neither works, and lines
   * take longer.
   */
  readonly kind: 'simulated' | 'usb' | 'radio';
  /** The board's name in messages. */
  readonly name: string;
  /** True if the board's USB chip is also used on the Arduino Nano. */
  readonly mayBeNano?: boolean;
  /** Called with the bytes that are received. */
  onBytes: (bytes: Uint8Array) => void;
  /** Called when the board is gone. */
  onGone?: (reason: string) => void;
  /** Called when a radio loses contact with its board, and when contact is restored. */
  onReach?: (isInReach: boolean) => void;
  /** Sends bytes. */
  write(bytes: Uint8Array): Promise<void>;
  /** Resets the board, as opening a port does, and sets the speed of a real line. */
  reset(baud?: number): Promise<void>;
  /** Waits in the board's time, which is simulated time for a simulated board. */
  wait(ms: number): Promise<void>;
  /** Closes the link; nothing is received afterwards. */
  close(): Promise<void>;
}

/** Timers in simulated time. */
export class Timers {
  private pendingTimers: { due: number; resolve: () => void }[] = [];

  /** Resolves once the simulated time has reached `due`. */
  waitUntil(due: number): Promise<void> {
    return new Promise((resolve) => this.pendingTimers.push({ due, resolve }));
  }

  /** Settles the timers that are due. */
  advanceTo(now: number): void {
    const dueTimers = this.pendingTimers.filter(({ due }) => due <= now);
    if (dueTimers.length === 0) return;
    this.pendingTimers = this.pendingTimers.filter(({ due }) => due > now);
    for (const { resolve: done } of dueTimers) done();
  }
}
