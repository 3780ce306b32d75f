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

const FREQUENCY_HZ = 16_000_000;
const FLASH_WORDS = 16 * 1024;
const SRAM_BYTES = 2048;
const EEPROM_BYTES = 1024;

/** Erase and write, 3.4 ms together (data sheet, table 8-2): half for each, since avr8js adds them. */
const EEPROM_CYCLES = (3.4e-3 * FREQUENCY_HZ) / 2;

const MCUSR = 0x54;
const SREG = 0x5f;
const I = 0x80;
const PORF = 0x01;
const RXC = 0x80;

export class Uno {
  /** Makes a board at power-on, with these corrections of avr8js and an empty flash. */
  constructor(corrections) {
    const flashWords = new Uint16Array(FLASH_WORDS).fill(0xffff);
    this.flash = new Uint8Array(flashWords.buffer);
    const cpu = new CPU(flashWords, SRAM_BYTES);
    this.cpu = cpu;
    this.ports = {
      B: new AVRIOPort(cpu, portBConfig),
      C: new AVRIOPort(cpu, portCConfig),
      D: new AVRIOPort(cpu, portDConfig),
    };
    const timers = [timer0Config, timer1Config, timer2Config];
    this.timers = timers.map((config) => new AVRTimer(cpu, config));
    this.usart = new AVRUSART(cpu, usart0Config, FREQUENCY_HZ);
    this.adc = new AVRADC(cpu, adcConfig);
    const cycles = { eraseCycles: EEPROM_CYCLES, writeCycles: EEPROM_CYCLES };
    const memory = new EEPROMMemoryBackend(EEPROM_BYTES);
    this.eeprom = new AVREEPROM(cpu, memory, { ...eepromConfig, ...cycles });
    /** The contents of the EEPROM, bytes. */
    this.memory = memory.memory;
    new AVRWatchdog(cpu, watchdogConfig, new AVRClock(cpu, FREQUENCY_HZ));
    cpu.data[MCUSR] = PORF;
    // avr8js resets the processor alone and leaves every peripheral as it was.
    cpu.reset = () => {
      throw new Error(`the watchdog resets the UNO at cycle ${cpu.cycles}, which avr8js does not simulate`);
    };

    /** The cycle at which the run ends. */
    this.until = 0;
    /** Functions that execute an instruction, and for each opcode the number of its own; 0 is avr8js. */
    this.executors = [avrInstruction];
    this.executorOf = new Uint8Array(0x10000);
    /** Called instead of an instruction while the processor sleeps; null while it is awake. */
    this.sleep = null;
    /** True if a port has changed. */
    this.hasChanged = false;
    /** Called after an instruction that has changed a port, before the events that are due by then. */
    this.afterChange = () => {};

    for (const correct of corrections) correct(this);
  }

  /** Executes the instructions whose opcode passes a test by `execute(cpu)`. Only these cost more time than avr8js itself. */
  executeBy(execute, matches) {
    const index = this.executors.push(execute) - 1;
    for (let opcode = 0; opcode <= 0xffff; opcode++) if (matches(opcode)) this.executorOf[opcode] = index;
  }

  /** Runs to a cycle, or an instruction farther. */
  run(endCycle) {
    const { cpu, executors, executorOf } = this;
    const { data, progMem } = cpu;
    this.until = endCycle;
    while (cpu.cycles < endCycle) {
      if (this.sleep !== null) {
        this.sleep();
      } else {
        const executor = executorOf[progMem[cpu.pc]];
        if (executor === 0) avrInstruction(cpu);
        else executors[executor](cpu);
      }
      if (this.hasChanged) {
        this.hasChanged = false;
        this.afterChange();
      }
      const event = cpu.nextClockEvent;
      const isDue = event !== null && event.cycles <= cpu.cycles;
      if (isDue || (cpu.nextInterrupt >= 0 && data[SREG] & I)) cpu.tick();
    }
  }

  /** Delivers bytes, each `{ cycle, byte }`, by the serial line. */
  deliver(bytes) {
    const { cpu, usart } = this;
    const queue = bytes.values();
    const deliverNext = () => {
      const { value } = queue.next();
      if (value === undefined) return;
      const arrive = () => {
        // The receiver of an ATmega holds two bytes and a third, that of avr8js one.
        if (cpu.data[usart.config.UCSRA] & RXC) {
          throw new Error(`at cycle ${cpu.cycles} a byte comes before the last was read, which avr8js does not simulate`);
        }
        usart.writeByte(value.byte, true);
        deliverNext();
      };
      cpu.addClockEvent(arrive, value.cycle - cpu.cycles);
    };
    deliverNext();
  }
}
