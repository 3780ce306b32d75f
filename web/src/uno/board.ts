// A simulated Arduino UNO that can be reset and flashed. The chip is that of tools/judge, on avr8js; a reset makes a
// new chip with the old memories.
import { skipBusyWaits } from '../../../tools/judge/src/busy-wait.js';
import { corrections } from '../../../tools/judge/src/corrections/index.js';
import { addReceiveBuffer } from '../../../tools/judge/src/receive-buffer.js';
import { Scope } from '../../../tools/judge/src/scope.js';
import { addSelfProgramming } from '../../../tools/judge/src/self-programming.js';
import { Uno } from '../../../tools/judge/src/uno.js';

/** Clock frequency of the chip, Hz. */
export const FREQUENCY_HZ = 16_000_000;

/** Number of bits per byte on the serial line, with start and stop bit. */
const BITS_PER_BYTE = 10;
/** Share by which a baud rate may differ from the chip's; beyond it every byte is garbled. */
const MAX_RATE_ERROR = 0.045;
/** The byte that replaces each byte received at a baud rate other than that of its sender; no text contains it. */
const UNREADABLE_BYTE = 0xfe;
/** Address of the register with the cause of the last reset. */
const MCUSR = 0x54;
/** Address of the RAM, after the registers. */
const RAM_START = 0x100;
/** Byte address of a boot loader of 512 bytes. */
export const BOOT_START = 0x7e00;

/** Causes of a reset as bits of MCUSR. */
const RESET_CAUSE_BITS = { power: 0x01, external: 0x02, watchdog: 0x08 };
export type ResetCause = keyof typeof RESET_CAUSE_BITS;

/** Thrown by the chip's watchdog to leave the run of a chip that is reset. */
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
  private cyclesBeforeReset = 0;
  /** The bytes that were sent to the UNO and have not arrived. */
  private readonly bytesToDeliver: number[] = [];
  private isLineBusy = false;
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
    if (bootLoader !== null) flash.set(bootLoader, BOOT_START);
    this.begin('power', flash, eeprom);
  }

  /** Cycles since power-on. */
  get cycle(): number {
    return this.cyclesBeforeReset + this.uno.cpu.cycles;
  }

  /** The whole flash. */
  get flash(): Uint8Array {
    return this.uno.flash;
  }

  /** The whole EEPROM. */
  get eeprom(): Uint8Array {
    return this.uno.eepromBytes;
  }

  /** Runs for a number of cycles. */
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
  reset(cause: ResetCause): void {
    const { cpu, flash, eepromBytes } = this.uno;
    this.cyclesBeforeReset += cpu.cycles;
    this.bytesToDeliver.length = 0;
    this.isLineBusy = false;
    const ram = cpu.data.slice(RAM_START);
    this.begin(cause, flash, eepromBytes);
    if (cause !== 'power') this.uno.cpu.data.set(ram, RAM_START);
  }

  private begin(cause: ResetCause, flash: Uint8Array, eeprom?: Uint8Array): void {
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
    new Scope(uno, (pin: number, rise: number, width: number) => this.onPulse(pin, cyclesBefore + rise, width));
  }

  /** True while the chip's baud rate and that of the other side differ too much. */
  private get isGarbled(): boolean {
    return Math.abs(this.uno.usart.baudRate / this.baud - 1) > MAX_RATE_ERROR;
  }

  private deliverNextByte(): void {
    const { uno } = this;
    if (this.isLineBusy || this.bytesToDeliver.length === 0) return;
    this.isLineBusy = true;
    uno.cpu.addClockEvent(() => {
      this.isLineBusy = false;
      const byte = this.bytesToDeliver.shift();
      if (uno !== this.uno || byte === undefined) return;
      if (!uno.receive?.(byte, this.isGarbled)) this.lost += 1;
      this.onReceived(byte, this.cycle);
      this.deliverNextByte();
    }, Math.round((BITS_PER_BYTE * FREQUENCY_HZ) / this.baud));
  }
}
