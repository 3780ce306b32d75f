// A boot loader waits for bytes and flags in loops that read one flag and jump back. Between two clock events nothing
// can change that flag, so the rounds that end before the next event pass in one step, to the same cycle.
import { avrInstruction } from 'avr8js';

/** Data addresses of the registers whose flags only a clock event or the program changes. */
const TIFR1 = 0x36;
const SPMCSR = 0x57;
const UCSR0A = 0xc0;
const FLAG_REGISTERS = new Set([TIFR1, SPMCSR, UCSR0A]);
const SREG = 0x5f;
const I = 0x80;
const IO_START = 0x20;

/** RJMP that jumps back by a number of words, its own included. */
const jumpBack = (words) => 0xd000 - words;
/** True for SBRS and SBRC. */
const isSkip = (opcode) => (opcode & 0xfc08) === 0xfc00;

/**
 * Returns the loop that ends at the jump at `pc`: the address of its flag register, the flag's bit, its value while the
 * loop goes on, and the cycles of a round. Null for any other loop.
 */
function loopAt(progMem, pc) {
  const [first, second, third] = [progMem[pc - 3], progMem[pc - 2], progMem[pc - 1]];
  switch (progMem[pc]) {
    case jumpBack(2): // sbis or sbic
      if ((third & 0xfd00) !== 0x9900) return null;
      return { address: IO_START + ((third >> 3) & 0x1f), bit: third & 7, value: third & 0x200 ? 0 : 1, period: 3 };
    case jumpBack(3): // in, then sbrs or sbrc
      if ((second & 0xf800) !== 0xb000 || !isSkip(third)) return null;
      return { address: IO_START + ((second & 0x600) >> 5) + (second & 0xf), bit: third & 7, value: third & 0x200 ? 0 : 1, period: 4 };
    case jumpBack(4): // lds, then sbrs or sbrc
      if ((first & 0xfe0f) !== 0x9000 || !isSkip(third)) return null;
      return { address: second, bit: third & 7, value: third & 0x200 ? 0 : 1, period: 5 };
    default:
      return null;
  }
}

export function busyWait(uno) {
  const { cpu } = uno;
  const { data, progMem } = cpu;
  const execute = () => {
    const loop = loopAt(progMem, cpu.pc);
    avrInstruction(cpu);
    if (loop === null || !FLAG_REGISTERS.has(loop.address) || ((data[loop.address] >> loop.bit) & 1) !== loop.value) return;
    // It comes after the jump.
    if (cpu.nextInterrupt >= 0 && data[SREG] & I) return;
    const nextCycle = Math.min(cpu.nextClockEvent?.cycles ?? Infinity, uno.until);
    const rounds = Math.floor((nextCycle - 1 - cpu.cycles) / loop.period);
    if (rounds > 0) cpu.cycles += rounds * loop.period;
  };
  const jumps = new Set([2, 3, 4].map(jumpBack));
  uno.executeBy(execute, (opcode) => jumps.has(opcode));
}
