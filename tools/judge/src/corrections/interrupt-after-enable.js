// After an instruction enables interrupts, one more instruction runs before any interrupt (data sheet, 7.7). Programs
// rely on this delay: the compiler restores the stack pointer by `out SREG` and then `out SPL`, and an interrupt
// between the two would overwrite the stack. avr8js serves the interrupt at once.
import { avrInstruction } from 'avr8js';

const SREG = 0x5f;
const SREG_I = 0x80;

/** Returns true for the opcodes of SEI, RETI, `out SREG`, and the stores that can reach SREG. */
const mayEnableInterrupts = (opcode) =>
  opcode === 0x9478 ||
  opcode === 0x9518 ||
  (opcode & 0xfe0f) === 0xbe0f ||
  (opcode & 0xd200) === 0x8200 || // std
  ((opcode & 0xfe00) === 0x9200 && (opcode & 0xf) < 0xf); // sts, st; not push

export function delayInterruptAfterEnable(uno) {
  const { cpu } = uno;
  const { data } = cpu;
  /** The cycle at which the last instruction that enabled interrupts ended. */
  let enabledCycle = -1;
  const execute = () => {
    const wasEnabled = data[SREG] & SREG_I;
    avrInstruction(cpu);
    if (!wasEnabled && data[SREG] & SREG_I) enabledCycle = cpu.cycles;
  };
  uno.overrideInstructions(execute, mayEnableInterrupts);
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const isJustEnabled = cpu.cycles === enabledCycle;
    if (isJustEnabled) data[SREG] &= ~SREG_I;
    tick();
    if (isJustEnabled) data[SREG] |= SREG_I;
  };
}
