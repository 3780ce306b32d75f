// A simulated Arduino UNO that can be reset and flashed. The chip is that of tools/judge, on avr8js; a reset makes a
// new chip with the old memories.
import { busyWait } from '../../../tools/judge/src/busy-wait.js';
import { corrections } from '../../../tools/judge/src/corrections/index.js';
import { receiveBuffer } from '../../../tools/judge/src/receive-buffer.js';
import { Scope } from '../../../tools/judge/src/scope.js';
import { selfProgramming } from '../../../tools/judge/src/self-programming.js';
import { Uno } from '../../../tools/judge/src/uno.js';

export const FREQUENCY = 16_000_000;

/** Number of bits per byte on the serial line, with start and stop bit. */
const BYTE_BITS = 10;
/** Share by which a baud rate may differ from the chip's; beyond it every byte is garbled. */
const RATE_ERROR = 0.045;
/** The byte in place of each one that is read at another baud rate than it was sent at; no text contains it. */
const UNREADABLE = 0xfe;
const MCUSR = 0x54;
/** Address of the RAM, after the registers. */
const RAM_START = 0x100;
/** Byte address of a boot loader of 512 bytes. */
export const BOOT = 0x7e00;

/** Causes of a reset as bits of MCUSR. */
const CAUSES = { power: 0x01, external: 0x02, watchdog: 0x08 };
export type Cause = keyof typeof CAUSES;

class ChipReset extends Error {}

export class SimulatedBoard {
  /** Called with each byte that the UNO has sent. */
  onByte: (byte: number) => void = () => {};
  /** Called when a pulse has ended: Arduino number of the pin, cycle of the rise, width in cycles. */
  onPulse: (pin: number, rise: number, width: number) => void = () => {};
  /** Called with each byte that was sent to the UNO when it arrives, and the cycle. */
  onReceived: (byte: number, cycle: number) => void = () => {};
  /** The baud rate of the other side of the serial line. */
  baud = 115_200;
  /** Number of bytes that the UNO's receiver has lost. */
  lost = 0;

  private uno!: Uno & { receive?(byte: number, isGarbled: boolean): boolean };
  /** Cycles from power-on to the last reset. */
  private before = 0;
  private readonly line: number[] = [];
  private lineIsBusy = false;
  private volts = 5;
  /** The contacts between pins and ground, by Arduino number: true if closed. */
  private readonly contacts = new Map<number, boolean>();

  /**
   * Starts a UNO at power-on. `image` is the beginning of flash, `bootLoader` what it has from `BOOT` on, `rail` the
   * converter's channel for the servos' rail and the voltage at its pin, `eeprom` the content of a previous board's
   * EEPROM.
   */
  constructor(
    image: Uint8Array | null,
    bootLoader: Uint8Array | null,
    private readonly rail: [number, number] | null,
    eeprom?: Uint8Array,
  ) {
    const flash = new Uint8Array(32 * 1024).fill(0xff);
    if (image !== null) flash.set(image);
    if (bootLoader !== null) flash.set(bootLoader, BOOT);
    this.begin('power', flash, eeprom);
  }

  /** Cycles since power-on. */
  get cycle(): number {
    return this.before + this.uno.cpu.cycles;
  }

  /** The whole flash. */
  get flash(): Uint8Array {
    return this.uno.flash;
  }

  /** The whole EEPROM. */
  get eeprom(): Uint8Array {
    return this.uno.memory;
  }

  /** Runs for a number of cycles. */
  run(cycles: number): void {
    const end = this.cycle + cycles;
    while (this.cycle < end) {
      try {
        this.uno.run(end - this.before);
      } catch (error) {
        if (!(error instanceof ChipReset)) throw error;
        this.reset('watchdog');
      }
    }
  }

  /** Sends bytes to the UNO; they arrive one by one, at the baud rate. */
  send(bytes: Iterable<number>): void {
    this.line.push(...bytes);
    this.deliverNextByte();
  }

  /** Sets the voltage of the board. */
  setSupply(volts: number): void {
    this.volts = volts;
    this.uno.adc.avcc = volts;
  }

  /** Opens or closes a contact between a pin and ground; while it is open, the pin's pull-up makes it high. */
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

  /** Resets the chip; flash, EEPROM and RAM keep their content. */
  reset(cause: Cause): void {
    const { cpu, flash, memory } = this.uno;
    this.before += cpu.cycles;
    this.line.length = 0;
    this.lineIsBusy = false;
    const ram = cpu.data.slice(RAM_START);
    this.begin(cause, flash, memory);
    if (cause !== 'power') this.uno.cpu.data.set(ram, RAM_START);
  }

  private begin(cause: Cause, flash: Uint8Array, eeprom?: Uint8Array): void {
    const uno = new Uno([...corrections, selfProgramming, receiveBuffer, busyWait]);
    this.uno = uno;
    uno.flash.set(flash);
    if (eeprom) uno.memory.set(eeprom);
    uno.cpu.data[MCUSR] = CAUSES[cause];
    uno.cpu.pc = flash[BOOT] === 0xff && flash[BOOT + 1] === 0xff ? 0 : BOOT / 2;
    uno.cpu.reset = () => {
      throw new ChipReset();
    };
    uno.adc.avcc = this.volts;
    if (this.rail) uno.adc.channelValues[this.rail[0]] = this.rail[1];
    for (const [pin, isClosed] of this.contacts) this.setPinLevel(pin, isClosed);
    uno.usart.onByteTransmit = (byte: number) => this.onByte(this.isGarbled ? UNREADABLE : byte);
    const cyclesBefore = this.before;
    new Scope(uno, (pin: number, rise: number, width: number) => this.onPulse(pin, cyclesBefore + rise, width));
  }

  /** True while the chip's baud rate and that of the other side differ too much. */
  private get isGarbled(): boolean {
    return Math.abs(this.uno.usart.baudRate / this.baud - 1) > RATE_ERROR;
  }

  private deliverNextByte(): void {
    const { uno } = this;
    if (this.lineIsBusy || this.line.length === 0) return;
    this.lineIsBusy = true;
    uno.cpu.addClockEvent(() => {
      this.lineIsBusy = false;
      const byte = this.line.shift();
      if (uno !== this.uno || byte === undefined) return;
      if (!uno.receive?.(byte, this.isGarbled)) this.lost += 1;
      this.onReceived(byte, this.cycle);
      this.deliverNextByte();
    }, Math.round((BYTE_BITS * FREQUENCY) / this.baud));
  }
}
