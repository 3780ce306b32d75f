// The Web Bluetooth link to a board with a Bluetooth LE module on its serial line. The module forwards bytes in packets
// and cannot reset the board. When the module is out of range, the link tries to reconnect.
import { sleep, type Link } from './link';

/** The serial services of the HM-10 and Nordic's modules, each with its characteristics for writing and reading. */
const SERIAL_SERVICES = [
  { service: 0xffe0, write: 0xffe1, read: 0xffe1 },
  {
    service: '6e400001-b5a3-f393-e0a9-e50e24dcca9e',
    write: '6e400002-b5a3-f393-e0a9-e50e24dcca9e',
    read: '6e400003-b5a3-f393-e0a9-e50e24dcca9e',
  },
];
/** Name prefixes of modules that do not advertise their service. */
const NAME_PREFIXES = ['HM', 'BT05', 'MLT-BT05', 'CC41', 'AT-09', 'JDY'];
/** Largest size of a packet, bytes. */
const MAX_PACKET_BYTES = 20;
/** Time between two attempts to reconnect, ms. */
const RETRY_MS = 500;
/** Time that `close` allows for earlier writes, ms. */
const CLOSE_TIMEOUT_MS = 500;

/** Web Bluetooth; undefined in a browser without it. */
const bluetooth = navigator.bluetooth as Bluetooth | undefined;
const isIos = /iPhone|iPad/.test(navigator.userAgent) || (navigator.platform === 'MacIntel' && navigator.maxTouchPoints > 1);
/** Advice for a user whose iPhone or iPad has no Web Bluetooth; null on another device or browser. */
export const IPHONE_ADVICE =
  isIos && !bluetooth ? 'On an iPhone or iPad, neither Safari nor Chrome can connect to a robot. The browser Bluefy can, through a Bluetooth LE module.' : null;

const NO_BLUETOOTH_MESSAGE = 'This browser cannot connect to a Bluetooth LE module. Chrome and Edge can, on localhost and over https; on Linux only with the flag "Experimental Web Platform features".';

/** Returns the reason if this browser cannot connect to a Bluetooth module; null if it can. */
export const findBluetoothProblem = () =>
  bluetooth ? null : (IPHONE_ADVICE ?? NO_BLUETOOTH_MESSAGE);

export class BluetoothLink implements Link {
  readonly kind = 'radio';
  readonly wait = sleep;
  onBytes: (bytes: Uint8Array) => void = () => {};
  onGone: (reason: string) => void = () => {};
  onRange: (isInRange: boolean) => void = () => {};
  private writeCharacteristic: BluetoothRemoteGATTCharacteristic | null = null;
  /** Settles when all previous writes are done. */
  private pendingWrites: Promise<void> = Promise.resolve();
  private isClosing = false;

  /** The module's GATT server; every picked Bluetooth LE device has a GATT server. */
  private readonly gatt: BluetoothRemoteGATTServer;

  private constructor(private readonly device: BluetoothDevice) {
    this.gatt = device.gatt!;
    device.addEventListener('gattserverdisconnected', () => void this.reconnect());
  }

  get name(): string {
    return `board at ${this.device.name || 'a Bluetooth module'}`;
  }

  /**
   * Connects to a module that the user picks; returns null if the user picks none. Throws an error with a message for
   * the user.
   */
  static async open(): Promise<BluetoothLink | null> {
    if (!bluetooth) throw new Error(findBluetoothProblem() ?? '');
    // False without a radio, and also if the page may not use the radio.
    const isAvailable = await bluetooth.getAvailability();
    const filters = [...SERIAL_SERVICES.map(({ service }) => ({ services: [service] })), ...NAME_PREFIXES.map((namePrefix) => ({ namePrefix }))];
    const request = bluetooth.requestDevice({ filters, optionalServices: SERIAL_SERVICES.map(({ service }) => service) });
    const device = await request.catch((error: unknown) => {
      // The browser reports the same error if the user closes the chooser and if the system denies permission; only the
      // messages differ.
      const isNotFound = error instanceof DOMException && error.name === 'NotFoundError';
      if (isNotFound && !isAvailable) throw new Error('Bluetooth is missing on this machine, or it is switched off.');
      if (isNotFound && !/permission|denied/i.test(error.message)) return null;
      throw new Error(`The browser may not use Bluetooth: allow it in the settings of the browser and of the system. The browser reports: ${String(error)}`);
    });
    if (!device) return null;
    const link = new BluetoothLink(device);
    await link.connect();
    return link;
  }

  private async connect(): Promise<void> {
    const server = await this.gatt.connect();
    for (const candidate of SERIAL_SERVICES) {
      const service = await server.getPrimaryService(candidate.service).catch(() => null);
      if (!service) continue;
      const readCharacteristic = await service.getCharacteristic(candidate.read);
      readCharacteristic.addEventListener('characteristicvaluechanged', this.forwardValue);
      await readCharacteristic.startNotifications();
      this.writeCharacteristic = candidate.write === candidate.read ? readCharacteristic : await service.getCharacteristic(candidate.write);
      return;
    }
    this.gatt.disconnect();
    throw new Error(`${this.device.name ?? 'The module'} has no serial service: expected service FFE0 of an HM-10, or Nordic's.`);
  }

  /** Forwards received bytes; one function, so that a second attempt to connect does not add another listener. */
  private readonly forwardValue = ({ target }: Event): void => {
    const { value } = target as BluetoothRemoteGATTCharacteristic;
    if (value) this.onBytes(new Uint8Array(value.buffer, value.byteOffset, value.byteLength).slice());
  };

  private async reconnect(): Promise<void> {
    // If the first connection fails, `open` reports it.
    if (this.isClosing || !this.writeCharacteristic) return;
    this.writeCharacteristic = null;
    this.onRange(false);
    while (!this.isClosing && !this.writeCharacteristic) {
      await sleep(RETRY_MS);
      // The page may leave the board during each wait.
      if (!this.isClosing) await this.connect().catch(() => {});
    }
    if (!this.isClosing) this.onRange(true);
  }

  write(bytes: Uint8Array): Promise<void> {
    return (this.pendingWrites = this.pendingWrites.catch(() => {}).then(() => this.sendPackets(bytes)));
  }

  private async sendPackets(bytes: Uint8Array): Promise<void> {
    for (let start = 0; start < bytes.length; start += MAX_PACKET_BYTES) {
      const characteristic = this.writeCharacteristic;
      if (!characteristic) throw new Error(`the ${this.name} is out of range`);
      const packet = bytes.slice(start, start + MAX_PACKET_BYTES);
      await (characteristic.properties.writeWithoutResponse ? characteristic.writeValueWithoutResponse(packet) : characteristic.writeValueWithResponse(packet));
    }
  }

  /** Does nothing: a Bluetooth module cannot reset a board. */
  async reset(): Promise<void> {}

  async close(): Promise<void> {
    this.isClosing = true;
    // Earlier writes are sent first, unless this takes too long.
    await Promise.race([this.pendingWrites.catch(() => {}), sleep(CLOSE_TIMEOUT_MS)]);
    this.gatt.disconnect();
  }
}
