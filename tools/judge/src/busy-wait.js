// A boot loader waits for bytes and flags in loops that read one flag and jump back. Between two clock events, nothing
// can change that flag. Therefore one step skips all iterations that end before the next event, and advances the cycle
// count as if they had run.
import { avrInstruction } from 'avr8js';

const TIFR1 = 0x36;
const SPMCSR = 0x57;
const UCSR0A = 0xc0;
/** Data addresses of registers whose flags change only by a clock event or by the program. */
const FLAG_REGISTERS = new Set([TIFR1, SPMCSR, UCSR0A]);
const IO_START = 0x20;

/** Returns the opcode of the RJMP that ends a loop of this many words, including the RJMP itself. */
const encodeRjmpBack = (words) => 0xd000 - words;
/** Returns true for SBRS and SBRC. */
const isSkip = (opcode) => (opcode & 0xfc08) === 0xfc00;

/**
 * Returns the loop that ends with the jump at `pc`: its flag register's address, the flag's bit, the flag's value
 * while the loop continues, and the cycles of an iteration. Returns null if the loop has another form; the caller must
 * check that the register is a flag register.
 */
function findFlagLoop(progMem, pc) {
  const [first, second, third] = [progMem[pc - 3], progMem[pc - 2], progMem[pc - 1]];
  const flag = { bit: third & 7, waitingValue: third & 0x200 ? 0 : 1 };
  switch (progMem[pc]) {
    case encodeRjmpBack(2): // sbis or sbic
      if ((third & 0xfd00) !== 0x9900) return null;
      return { ...flag, address: IO_START + ((third >> 3) & 0x1f), iterationCycles: 3 };
    case encodeRjmpBack(3): // in, then sbrs or sbrc
      if ((second & 0xf800) !== 0xb000 || !isSkip(third)) return null;
      return { ...flag, address: IO_START + ((second & 0x600) >> 5) + (second & 0xf), iterationCycles: 4 };
    case encodeRjmpBack(4): // lds, then sbrs or sbrc
      if ((first & 0xfe0f) !== 0x9000 || !isSkip(third)) return null;
      return { ...flag, address: second, iterationCycles: 5 };
    default:
      return null;
  }
}

export function skipBusyWaits(uno) {
  const { cpu } = uno;
  const { data, progMem } = cpu;
  const execute = () => {
    const loop = findFlagLoop(progMem, cpu.pc);
    avrInstruction(cpu);
    if (loop === null || !FLAG_REGISTERS.has(loop.address)) return;
    if (((data[loop.address] >> loop.bit) & 1) !== loop.waitingValue) return;
    // A pending interrupt is served before the next iteration.
    if (cpu.nextInterrupt >= 0 && cpu.interruptsEnabled) return;
    const nextCycle = Math.min(cpu.nextClockEvent?.cycles ?? Infinity, uno.endCycle);
    const iterationCount = Math.floor((nextCycle - 1 - cpu.cycles) / loop.iterationCycles);
    if (iterationCount > 0) cpu.cycles += iterationCount * loop.iterationCycles;
  };
  const jumpOpcodes = new Set([2, 3, 4].map(encodeRjmpBack));
  uno.overrideInstructions(execute, (opcode) => jumpOpcodes.has(opcode));
}
