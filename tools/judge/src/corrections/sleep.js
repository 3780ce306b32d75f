// avr8js treats SLEEP as a NOP. Here time jumps from event to event until an interrupt is pending. The response to an
// interrupt takes four cycles longer from sleep (data sheet, 7.7.1).
import { avrInstruction } from 'avr8js';

const SLEEP = 0x9588;
const SMCR = 0x53;
const SE = 1;
const WAKING_CYCLES = 4;

export function simulateSleep(uno) {
  const { cpu } = uno;
  const passTime = () => {
    const nextCycle = cpu.nextClockEvent?.cycles ?? Infinity;
    cpu.cycles = Math.max(cpu.cycles, Math.min(nextCycle, uno.endCycle));
  };
  const execute = () => {
    const isSleepEnabled = cpu.data[SMCR] & SE;
    avrInstruction(cpu);
    if (isSleepEnabled && cpu.nextInterrupt < 0) uno.passSleep = passTime;
  };
  uno.overrideInstructions(execute, (opcode) => opcode === SLEEP);
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const pc = cpu.pc;
    tick();
    if (uno.passSleep !== null && cpu.pc !== pc) {
      uno.passSleep = null;
      cpu.cycles += WAKING_CYCLES;
    }
  };
}
