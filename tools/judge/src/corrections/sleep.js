// avr8js treats SLEEP as a NOP. Here time passes from event to event until an interrupt
// is due; its entry takes four cycles more than from an awake processor (data sheet, 7.7.1).
import { avrInstruction } from 'avr8js';

const SLEEP = 0x9588;
const SMCR = 0x53;
const SE = 1;
const WAKING_CYCLES = 4;

export function sleep(uno) {
  const { cpu } = uno;
  const passTime = () => {
    const nextCycle = cpu.nextClockEvent?.cycles ?? Infinity;
    cpu.cycles = Math.max(cpu.cycles, Math.min(nextCycle, uno.until));
  };
  const execute = () => {
    const isSleepEnabled = cpu.data[SMCR] & SE;
    avrInstruction(cpu);
    if (isSleepEnabled && cpu.nextInterrupt < 0) uno.sleep = passTime;
  };
  uno.executeBy(execute, (opcode) => opcode === SLEEP);
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const pc = cpu.pc;
    tick();
    if (uno.sleep !== null && cpu.pc !== pc) {
      uno.sleep = null;
      cpu.cycles += WAKING_CYCLES;
    }
  };
}
