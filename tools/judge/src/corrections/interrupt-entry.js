// An interrupt is entered in four cycles (data sheet, 7.7.1); in avr8js in two.
const MISSING = 2;

export function interruptEntry({ cpu }) {
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const wereOn = cpu.interruptsEnabled;
    tick();
    const entered = wereOn && !cpu.interruptsEnabled;
    if (entered) cpu.cycles += MISSING;
  };
}
