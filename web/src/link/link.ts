// The serial link to a simulated UNO, or to a board by USB or radio.

/** The baud rate of the firmware, and of every link that is not told another one. */
export const BAUD = 115_200;
/** The error message if the board was unplugged. */
export const GONE_MESSAGE = 'the board is not connected any more';

export const sleep = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export interface Link {
  /**
   * The kind of link. Over USB a board is reset when its port is opened, and its flash can be written; over radio
   * neither works, and lines take longer.
   */
  readonly kind: 'simulated' | 'usb' | 'radio';
  /** The board's name in messages. */
  readonly name: string;
  /** True if the board may be an Arduino Nano: its USB chip is used on both. */
  readonly mayBeNano?: boolean;
  /** Called with received bytes. */
  onBytes: (bytes: Uint8Array) => void;
  /** Called when the board is gone, with the reason as a sentence. */
  onGone?: (reason: string) => void;
  /** Called with false when a radio loses contact with its board, and with true when contact is restored. */
  onReach?: (isInReach: boolean) => void;
  /** Sends bytes. */
  write(bytes: Uint8Array): Promise<void>;
  /** Resets the board, as opening a port does, and sets the baud rate of a real line. */
  reset(baud?: number): Promise<void>;
  /** Waits in the board's time, which for a simulated board is simulated time. */
  wait(ms: number): Promise<void>;
  /** Closes the link; nothing is received afterwards. */
  close(): Promise<void>;
}

/** Timers in simulated time; its unit is up to the caller. */
export class Timers {
  private pendingTimers: { due: number; resolve: () => void }[] = [];

  /** Resolves once the simulated time has reached `due`. */
  waitUntil(due: number): Promise<void> {
    return new Promise((resolve) => this.pendingTimers.push({ due, resolve }));
  }

  /** Resolves the timers that are due at `now`. */
  advanceTo(now: number): void {
    const dueTimers = this.pendingTimers.filter(({ due }) => due <= now);
    if (dueTimers.length === 0) return;
    this.pendingTimers = this.pendingTimers.filter(({ due }) => due > now);
    for (const { resolve } of dueTimers) resolve();
  }
}
