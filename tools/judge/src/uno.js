// An Arduino UNO simulated by avr8js: an ATmega328P at 16 MHz, its peripherals and its serial line.
import {
  AVRADC, AVRClock, AVREEPROM, AVRIOPort, AVRTimer, AVRUSART, AVRWatchdog, CPU, EEPROMMemoryBackend,
  adcConfig, avrInstruction, eepromConfig, portBConfig, portCConfig, portDConfig,
  timer0Config, timer1Config, timer2Config, usart0Config, watchdogConfig,
} from 'avr8js';

const FREQUENCY_HZ = 16_000_000;
const FLASH_WORDS = 16 * 1024;
const SRAM_BYTES = 2048;
const EEPROM_BYTES = 1024;

/** Cycles of an erase, and of a write. Together they take 3.4 ms (data sheet, table 8-2); avr8js adds both. */
const EEPROM_CYCLES = (3.4e-3 * FREQUENCY_HZ) / 2;

const MCUSR = 0x54;
const PORF = 0x01;
const RXC = 0x80;

export class Uno {
  /** Makes a board at power-on with empty flash. Each of `corrections` is a function that corrects the simulation. */
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
    const eepromMemory = new EEPROMMemoryBackend(EEPROM_BYTES);
    this.eeprom = new AVREEPROM(cpu, eepromMemory, { ...eepromConfig, ...cycles });
    /** The contents of the EEPROM. */
    this.eepromBytes = eepromMemory.memory;
    this.watchdog = new AVRWatchdog(cpu, watchdogConfig, new AVRClock(cpu, FREQUENCY_HZ));
    cpu.data[MCUSR] = PORF;
    // avr8js would reset the processor only, not the peripherals.
    cpu.reset = () => {
      throw new Error(`the watchdog resets the UNO at cycle ${cpu.cycles}, but avr8js cannot simulate a reset`);
    };

    /** The cycle at which the run ends. */
    this.endCycle = 0;
    /** Functions that execute an instruction; the one at index 0 belongs to avr8js. */
    this.executors = [avrInstruction];
    /** The index in `executors` for each opcode. */
    this.executorIndexes = new Uint8Array(0x10000);
    /** Function called instead of an instruction while the processor sleeps; null while it is awake. */
    this.passTimeAsleep = null;
    /** True if a port changed during the last instruction. */
    this.hasPortChanged = false;
    /** Function called after an instruction that changed a port, before any due events. */
    this.afterPortChange = () => {};

    for (const correct of corrections) correct(this);
  }

  /** Makes `execute(cpu)` execute all instructions whose opcode `matches`. Other instructions keep their speed. */
  overrideInstructions(execute, matches) {
    const index = this.executors.push(execute) - 1;
    for (let opcode = 0; opcode <= 0xffff; opcode++) if (matches(opcode)) this.executorIndexes[opcode] = index;
  }

  /** Runs to `endCycle`; the last instruction may end later. */
  run(endCycle) {
    const { cpu, executors, executorIndexes } = this;
    const { progMem } = cpu;
    this.endCycle = endCycle;
    while (cpu.cycles < endCycle) {
      if (this.passTimeAsleep !== null) {
        this.passTimeAsleep();
      } else {
        const index = executorIndexes[progMem[cpu.pc]];
        if (index === 0) avrInstruction(cpu);
        else executors[index](cpu);
      }
      if (this.hasPortChanged) {
        this.hasPortChanged = false;
        this.afterPortChange();
      }
      const event = cpu.nextClockEvent;
      const isDue = event !== null && event.cycles <= cpu.cycles;
      if (isDue || (cpu.nextInterrupt >= 0 && cpu.interruptsEnabled)) cpu.tick();
    }
  }

  /** Schedules the arrival of serial bytes, each `{ cycle, byte }`. */
  scheduleBytes(bytes) {
    const { cpu, usart } = this;
    const queue = bytes.values();
    const scheduleNext = () => {
      const { value } = queue.next();
      if (value === undefined) return;
      const arrive = () => {
        // The receiver of an ATmega holds three bytes, but avr8js simulates only one.
        if (cpu.data[usart.config.UCSRA] & RXC) {
          throw new Error(`at cycle ${cpu.cycles} a byte arrives before the last one was read, but avr8js cannot simulate an overrun`);
        }
        usart.writeByte(value.byte, true);
        scheduleNext();
      };
      cpu.addClockEvent(arrive, value.cycle - cpu.cycles);
    };
    scheduleNext();
  }
}
