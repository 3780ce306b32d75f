// An Arduino UNO on avr8js: an ATmega328P at 16 MHz, its peripherals and its serial line.
import {
  AVRADC,
  AVRClock,
  AVREEPROM,
  AVRIOPort,
  AVRTimer,
  AVRUSART,
  AVRWatchdog,
  CPU,
  EEPROMMemoryBackend,
  adcConfig,
  avrInstruction,
  eepromConfig,
  portBConfig,
  portCConfig,
  portDConfig,
  timer0Config,
  timer1Config,
  timer2Config,
  usart0Config,
  watchdogConfig,
} from 'avr8js';

const FREQUENCY = 16_000_000;
const FLASH_WORDS = 16 * 1024;
const SRAM = 2048;
const EEPROM = 1024;

/** Erase and write, 3.4 ms together (data sheet, table 8-2): half for each, since avr8js adds them. */
const EEPROM_CYCLES = (3.4e-3 * FREQUENCY) / 2;

const MCUSR = 0x54;
const PORF = 0x01;
const RXC = 0x80;

export class Uno {
  /** Makes a board at power-on, with these corrections of avr8js and an empty flash. */
  constructor(corrections) {
    const words = new Uint16Array(FLASH_WORDS).fill(0xffff);
    this.flash = new Uint8Array(words.buffer);
    const cpu = new CPU(words, SRAM);
    this.cpu = cpu;
    this.ports = {
      B: new AVRIOPort(cpu, portBConfig),
      C: new AVRIOPort(cpu, portCConfig),
      D: new AVRIOPort(cpu, portDConfig),
    };
    const timers = [timer0Config, timer1Config, timer2Config];
    this.timers = timers.map((config) => new AVRTimer(cpu, config));
    this.usart = new AVRUSART(cpu, usart0Config, FREQUENCY);
    this.adc = new AVRADC(cpu, adcConfig);
    const cycles = { eraseCycles: EEPROM_CYCLES, writeCycles: EEPROM_CYCLES };
    const memory = new EEPROMMemoryBackend(EEPROM);
    this.eeprom = new AVREEPROM(cpu, memory, { ...eepromConfig, ...cycles });
    /** The contents of the EEPROM, bytes. */
    this.memory = memory.memory;
    new AVRWatchdog(cpu, watchdogConfig, new AVRClock(cpu, FREQUENCY));
    cpu.data[MCUSR] = PORF;
    // avr8js resets the processor alone and leaves every peripheral as it was.
    cpu.reset = () => {
      throw new Error(`the watchdog resets the UNO at cycle ${cpu.cycles}, which avr8js does not simulate`);
    };

    /** The cycle at which the run ends. */
    this.until = 0;
    /** Executes an instruction; corrections wrap it. */
    this.instruction = () => avrInstruction(cpu);
    /** Called after an instruction, before the events that are due by then. */
    this.afterInstruction = () => {};

    for (const correct of corrections) correct(this);
  }

  /** Runs to a cycle, or an instruction farther. */
  run(until) {
    const { cpu } = this;
    this.until = until;
    while (cpu.cycles < until) {
      this.instruction();
      this.afterInstruction();
      const event = cpu.nextClockEvent;
      if (cpu.nextInterrupt >= 0 || (event !== null && event.cycles <= cpu.cycles)) cpu.tick();
    }
  }

  /** Delivers bytes, each `{ cycle, byte }`, by the serial line. */
  deliver(bytes) {
    const { cpu, usart } = this;
    const queue = bytes.values();
    const next = () => {
      const { value } = queue.next();
      if (value === undefined) return;
      const arrive = () => {
        // The receiver of an ATmega holds two bytes and a third, that of avr8js one.
        if (cpu.data[usart.config.UCSRA] & RXC) {
          throw new Error(`at cycle ${cpu.cycles} a byte comes before the last was read, which avr8js does not simulate`);
        }
        usart.writeByte(value.byte, true);
        next();
      };
      cpu.addClockEvent(arrive, value.cycle - cpu.cycles);
    };
    next();
  }
}
