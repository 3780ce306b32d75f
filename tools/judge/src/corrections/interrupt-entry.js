// An interrupt is entered in four cycles (data sheet, 7.7.1); in avr8js in two.
const MISSING_CYCLES = 2;

export function interruptEntry({ cpu }) {
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const wereEnabled = cpu.interruptsEnabled;
    tick();
    const isEntered = wereEnabled && !cpu.interruptsEnabled;
    if (isEntered) cpu.cycles += MISSING_CYCLES;
  };
}
