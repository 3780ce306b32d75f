// The response to an interrupt takes four cycles (data sheet, 7.7.1), but only two in avr8js.
const MISSING_CYCLES = 2;

export function extendInterruptEntry({ cpu }) {
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const wasEnabled = cpu.interruptsEnabled;
    tick();
    const hasEntered = wasEnabled && !cpu.interruptsEnabled;
    if (hasEntered) cpu.cycles += MISSING_CYCLES;
  };
}
