// avr8js treats SLEEP as a NOP. Here time passes from event to event until an interrupt
// is due; its entry takes four cycles more than from an awake processor (data sheet, 7.7.1).
const SLEEP = 0x9588;
const SMCR = 0x53;
const SE = 1;
const WAKING = 4;

export function sleep(uno) {
  const { cpu } = uno;
  const instruction = uno.instruction;
  let asleep = false;
  uno.instruction = () => {
    if (asleep) {
      const next = cpu.nextClockEvent?.cycles ?? Infinity;
      cpu.cycles = Math.max(cpu.cycles, Math.min(next, uno.until));
      return;
    }
    const sleeps = cpu.progMem[cpu.pc] === SLEEP && cpu.data[SMCR] & SE;
    instruction();
    asleep = sleeps && cpu.nextInterrupt < 0;
  };
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const pc = cpu.pc;
    tick();
    if (asleep && cpu.pc !== pc) {
      asleep = false;
      cpu.cycles += WAKING;
    }
  };
}
