// A simulated Arduino UNO that can be reset and flashed. It uses the chip of tools/judge, on avr8js; a reset creates a
// new chip with the memory contents of the previous chip.
import { skipBusyWaits } from '../../../tools/judge/src/busy-wait.js';
import { corrections } from '../../../tools/judge/src/corrections/index.js';
import { recordPulses } from '../../../tools/judge/src/pulse-recorder.js';
import { addReceiveBuffer } from '../../../tools/judge/src/receive-buffer.js';
import { addSelfProgramming } from '../../../tools/judge/src/self-programming.js';
import { Uno } from '../../../tools/judge/src/uno.js';

/** Clock frequency of the chip, Hz. */
export const FREQUENCY_HZ = 16_000_000;

/** Number of bits per byte on the serial line, including start bit and stop bit. */
const BITS_PER_BYTE = 10;
/** Largest relative difference between the two baud rates; beyond it, every byte is garbled. */
const MAX_BAUD_ERROR = 0.045;
/** The substitute for a byte received at a wrong baud rate; no text contains it. */
const UNREADABLE_BYTE = 0xfe;
/** Data address of the register that has the cause of the last reset. */
const MCUSR = 0x54;
/** Data address at which the RAM starts, after the registers. */
const RAM_START = 0x100;
/** Byte address of a 512-byte boot loader in flash. */
const BOOT_START = 0x7e00;

/** The bit of MCUSR for each cause of a reset. */
const RESET_CAUSE_BITS = { power: 0x01, external: 0x02, watchdog: 0x08 };
type ResetCause = keyof typeof RESET_CAUSE_BITS;

/** Thrown when the watchdog resets the chip, to end the chip's run. */
class ChipReset extends Error {}

export class SimulatedBoard {
  /** Called with each byte that the UNO sends. */
  onByte: (byte: number) => void = () => {};
  /** Called at the end of each pulse: Arduino number of the pin, cycle of the rising edge, width in cycles. */
  onPulse: (pin: number, riseCycle: number, width: number) => void = () => {};
  /** Called with each byte that arrives at the UNO, and its cycle. */
  onReceived: (byte: number, cycle: number) => void = () => {};
  /** The baud rate at the other end of the serial line. */
  baud = 115_200;

  private uno!: Uno & { receive?(byte: number, isGarbled: boolean): boolean };
  /** Number of cycles from power-on to the last reset. */
  private cyclesBeforeReset = 0;
  /** Bytes on the way to the UNO. */
  private readonly bytesToDeliver: number[] = [];
  private isLineBusy = false;
  private volts = 5;
  /** State of the contacts between pins and ground by the pins' Arduino numbers: true if closed. */
  private readonly contacts = new Map<number, boolean>();

  /**
   * Powers on a UNO. `image` is the flash content from address 0, `bootLoader` the flash content from `BOOT_START`,
   * `rail` the ADC channel of the servos' rail and the voltage at its pin, and `eeprom` the content of the previous
   * board's EEPROM.
   */
  constructor(
    image: Uint8Array | null,
    bootLoader: Uint8Array | null,
    private readonly rail: [number, number] | null,
    eeprom?: Uint8Array,
  ) {
    const flash = new Uint8Array(32 * 1024).fill(0xff);
    if (image !== null) flash.set(image);
    if (bootLoader !== null) flash.set(bootLoader, BOOT_START);
    this.startChip('power', flash, eeprom);
  }

  /** Cycles since power-on. */
  get cycle(): number {
    return this.cyclesBeforeReset + this.uno.cpu.cycles;
  }

  /** The content of the whole flash. */
  get flash(): Uint8Array {
    return this.uno.flash;
  }

  /** The content of the whole EEPROM. */
  get eeprom(): Uint8Array {
    return this.uno.eepromBytes;
  }

  run(cycles: number): void {
    const end = this.cycle + cycles;
    while (this.cycle < end) {
      try {
        this.uno.run(end - this.cyclesBeforeReset);
      } catch (error) {
        if (!(error instanceof ChipReset)) throw error;
        this.reset('watchdog');
      }
    }
  }

  /** Sends bytes to the UNO; they arrive one by one, at the baud rate. */
  send(bytes: Iterable<number>): void {
    this.bytesToDeliver.push(...bytes);
    this.deliverNextByte();
  }

  setSupply(volts: number): void {
    this.volts = volts;
    this.uno.adc.avcc = volts;
  }

  /** Opens or closes a contact between a pin and ground; while it is open, the pull-up keeps the pin high. */
  setContact(pin: number, isClosed: boolean): void {
    this.contacts.set(pin, isClosed);
    this.setPinLevel(pin, isClosed);
  }

  private setPinLevel(pin: number, isClosed: boolean): void {
    const { B, C, D } = this.uno.ports;
    if (pin < 8) D.setPin(pin, !isClosed);
    else if (pin < 14) B.setPin(pin - 8, !isClosed);
    else C.setPin(pin - 14, !isClosed);
  }

  /** Resets the chip. Flash and EEPROM keep their contents; the RAM keeps its content except at power-on. */
  reset(cause: ResetCause): void {
    const { cpu, flash, eepromBytes } = this.uno;
    this.cyclesBeforeReset += cpu.cycles;
    this.bytesToDeliver.length = 0;
    this.isLineBusy = false;
    const ram = cpu.data.slice(RAM_START);
    this.startChip(cause, flash, eepromBytes);
    if (cause !== 'power') this.uno.cpu.data.set(ram, RAM_START);
  }

  /** Creates a chip with these memories in its state after a reset by this cause. */
  private startChip(cause: ResetCause, flash: Uint8Array, eeprom?: Uint8Array): void {
    const uno = new Uno([...corrections, addSelfProgramming, addReceiveBuffer, skipBusyWaits]);
    this.uno = uno;
    uno.flash.set(flash);
    if (eeprom) uno.eepromBytes.set(eeprom);
    uno.cpu.data[MCUSR] = RESET_CAUSE_BITS[cause];
    uno.cpu.pc = flash[BOOT_START] === 0xff && flash[BOOT_START + 1] === 0xff ? 0 : BOOT_START / 2;
    uno.cpu.reset = () => {
      throw new ChipReset();
    };
    uno.adc.avcc = this.volts;
    if (this.rail) uno.adc.channelValues[this.rail[0]] = this.rail[1];
    for (const [pin, isClosed] of this.contacts) this.setPinLevel(pin, isClosed);
    uno.usart.onByteTransmit = (byte: number) => this.onByte(this.isGarbled ? UNREADABLE_BYTE : byte);
    const cyclesBefore = this.cyclesBeforeReset;
    recordPulses(uno, (pin: number, riseCycle: number, width: number) => this.onPulse(pin, cyclesBefore + riseCycle, width));
  }

  /** True if the baud rates of the chip and the other end differ too much. */
  private get isGarbled(): boolean {
    return Math.abs(this.uno.usart.baudRate / this.baud - 1) > MAX_BAUD_ERROR;
  }

  private deliverNextByte(): void {
    const { uno } = this;
    if (this.isLineBusy || this.bytesToDeliver.length === 0) return;
    this.isLineBusy = true;
    uno.cpu.addClockEvent(() => {
      this.isLineBusy = false;
      const byte = this.bytesToDeliver.shift();
      if (uno !== this.uno || byte === undefined) return;
      uno.receive?.(byte, this.isGarbled);
      this.onReceived(byte, this.cycle);
      this.deliverNextByte();
    }, Math.round((BITS_PER_BYTE * FREQUENCY_HZ) / this.baud));
  }
}
