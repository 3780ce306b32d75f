// The Web Serial link to a board, over USB or through an HC-05, a Bluetooth module that the system offers as a serial
// port. Chromium browsers and newer Firefox have Web Serial, over https or on localhost.
import { getMessage } from '../problem';
import { BAUD_RATE, GONE_MESSAGE, sleep, type Link } from './link';

/** The UUID of Bluetooth's serial port profile, which an HC-05 uses. */
const SERIAL_PROFILE = '00001101-0000-1000-8000-00805f9b34fb';
/** The USB vendor ids of arduino.cc and arduino.org, whose chips are used on UNOs but not on Nanos. */
const ARDUINO_VENDOR_IDS = [0x2341, 0x2a03];
export const NO_SERIAL_MESSAGE = 'This browser cannot connect to a board on USB, because it has no Web Serial. Chrome, Chromium, Edge and newer Firefox have Web Serial, on localhost and over https.';
/** Duration of the pulse on the reset line, ms. */
const RESET_PULSE_MS = 50;

/** Returns true if this browser has Web Serial. */
export const hasSerial = () => Boolean(navigator.serial);

export class PortLink implements Link {
  readonly wait = sleep;
  onBytes: (bytes: Uint8Array) => void = () => {};
  onGone: (reason: string) => void = () => {};
  private reader: ReadableStreamDefaultReader<Uint8Array> | null = null;
  private writer: WritableStreamDefaultWriter<Uint8Array> | null = null;
  private isClosing = false;
  /** True once the page has left the board; the port then stays closed. */
  private isLeft = false;
  private baud = BAUD_RATE;
  /** Settles when reading from the port ends. */
  private readLoop: Promise<void> = Promise.resolve();

  private constructor(private readonly port: SerialPort) {}

  get kind(): 'usb' | 'radio' {
    return this.port.getInfo().bluetoothServiceClassId === undefined ? 'usb' : 'radio';
  }

  get name(): string {
    return this.kind === 'usb' ? 'board on USB' : 'board on Bluetooth';
  }

  get mayBeNano(): boolean {
    const { usbVendorId } = this.port.getInfo();
    return usbVendorId !== undefined && !ARDUINO_VENDOR_IDS.includes(usbVendorId);
  }

  /**
   * Opens a port that the user picks; this resets a UNO. Returns null if the user cancels. Throws an error with a
   * message for the user.
   */
  static async open(): Promise<PortLink | null> {
    if (!hasSerial()) throw new Error(NO_SERIAL_MESSAGE);
    const request = navigator.serial.requestPort({ allowedBluetoothServiceClassIds: [SERIAL_PROFILE] });
    const port = await request.catch((error: unknown) => {
      // The user closed the chooser without a choice.
      if (error instanceof DOMException && error.name === 'NotFoundError') return null;
      throw error;
    });
    if (!port) return null;
    const link = new PortLink(port);
    await link.openPort().catch((error: unknown) => {
      throw new Error(`${getMessage(error)} Another program may be using the port: close the program, and connect again.`);
    });
    return link;
  }

  private async openPort(): Promise<void> {
    await this.port.open({ baudRate: this.baud, bufferSize: 4096 });
    this.isClosing = false;
    this.readLoop = this.readUntilClosed();
  }

  async write(bytes: Uint8Array): Promise<void> {
    const { writable } = this.port;
    if (!writable || this.isClosing) throw new Error(GONE_MESSAGE);
    this.writer ??= writable.getWriter();
    await this.writer.write(bytes).catch(() => Promise.reject(new Error(GONE_MESSAGE)));
  }

  async reset(baud = this.baud): Promise<void> {
    if (this.kind === 'radio') return;
    if (baud !== this.baud) {
      // The baud rate can be set only when the port is opened.
      await this.closePort();
      this.baud = baud;
      // The page may leave the board during each wait.
      if (this.isLeft) throw new Error(GONE_MESSAGE);
      await this.openPort().catch((error: unknown) => {
        if (!this.isLeft) this.onGone(getMessage(error));
        throw new Error(GONE_MESSAGE);
      });
      if (this.isLeft) await this.closePort();
    }
    for (const isLow of [false, true]) {
      await this.port.setSignals({ dataTerminalReady: isLow, requestToSend: isLow }).catch(() => Promise.reject(new Error(GONE_MESSAGE)));
      await sleep(RESET_PULSE_MS);
    }
  }

  close(): Promise<void> {
    this.isLeft = true;
    return this.closePort();
  }

  private async closePort(): Promise<void> {
    this.isClosing = true;
    await this.reader?.cancel().catch(() => {});
    await this.readLoop;
    this.writer?.releaseLock();
    this.writer = null;
    await this.port.close().catch(() => {});
  }

  private async readUntilClosed(): Promise<void> {
    let reason = 'its port is closed.';
    // After a line error (break, framing error), the port has a new stream; after an unplugged board, it has none.
    let endedStream: ReadableStream<Uint8Array> | null = null;
    while (this.port.readable && this.port.readable !== endedStream && !this.isClosing) {
      endedStream = this.port.readable;
      this.reader = endedStream.getReader();
      try {
        for (;;) {
          const { value, done } = await this.reader.read();
          if (done) break;
          if (value) this.onBytes(value);
        }
      } catch (error) {
        reason = getMessage(error);
      } finally {
        this.reader.releaseLock();
      }
    }
    if (!this.isClosing) this.onGone(reason);
  }
}
