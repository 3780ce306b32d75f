// The serial link to a simulated UNO, or to a board over USB or radio.

/** The firmware's baud rate, which is every link's default. */
export const BAUD_RATE = 115_200;
/** The error message for an unplugged board. */
export const GONE_MESSAGE = 'the board is no longer connected';

export const sleep = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export interface Link {
  /**
   * The kind of link. Over USB, opening the port resets the board, and its flash can be written. Over radio, neither
   * works, and lines take longer.
   */
  readonly kind: 'simulated' | 'usb' | 'radio';
  /** The board's name in messages. */
  readonly name: string;
  /** True if the board may be an Arduino Nano, because both boards use its USB chip. */
  readonly mayBeNano?: boolean;
  onBytes: (bytes: Uint8Array) => void;
  /** Called with the reason, a sentence, when the board is gone. */
  onGone?: (reason: string) => void;
  /** Called with false when a radio's board goes out of range, and with true when it is back in range. */
  onRange?: (isInRange: boolean) => void;
  write(bytes: Uint8Array): Promise<void>;
  /** Resets the board, as opening a port does, and sets the baud rate of a real line. */
  reset(baud?: number): Promise<void>;
  /** Waits in the board's time, which is simulated time for a simulated board. */
  wait(ms: number): Promise<void>;
  /** Closes the link; nothing is received afterwards. */
  close(): Promise<void>;
}
