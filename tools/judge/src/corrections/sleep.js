// avr8js treats SLEEP as a NOP. Here time jumps from event to event until an interrupt is pending. The response to an
// interrupt takes four cycles longer from sleep (data sheet, 7.7.1).
import { avrInstruction } from 'avr8js';

const SLEEP_OPCODE = 0x9588;
const SMCR = 0x53;
const SE_MASK = 1;
const WAKING_CYCLES = 4;

export function simulateSleep(uno) {
  const { cpu } = uno;
  const passTimeAsleep = () => {
    const nextCycle = cpu.nextClockEvent?.cycles ?? Infinity;
    cpu.cycles = Math.max(cpu.cycles, Math.min(nextCycle, uno.endCycle));
  };
  const execute = () => {
    const isSleepEnabled = cpu.data[SMCR] & SE_MASK;
    avrInstruction(cpu);
    if (isSleepEnabled && cpu.nextInterrupt < 0) uno.passTimeAsleep = passTimeAsleep;
  };
  uno.overrideInstructions(execute, (opcode) => opcode === SLEEP_OPCODE);
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const pc = cpu.pc;
    tick();
    if (uno.passTimeAsleep !== null && cpu.pc !== pc) {
      uno.passTimeAsleep = null;
      cpu.cycles += WAKING_CYCLES;
    }
  };
}
