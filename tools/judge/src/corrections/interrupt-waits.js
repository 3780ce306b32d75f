// The instruction after the one that switches interrupts on runs before any interrupt (data sheet,
// 7.7). Programs rely on it: the compiler restores the stack pointer by `out SREG` and `out SPL`, and
// an interrupt between the two overwrites the stack. avr8js serves it at once.
const SREG = 0x5f;
const I = 0x80;

export function interruptWaits(uno) {
  const { cpu } = uno;
  const { data } = cpu;
  const instruction = uno.instruction;
  let justOn = false;
  uno.instruction = () => {
    const wasOn = data[SREG] & I;
    instruction();
    justOn = !wasOn && data[SREG] & I;
  };
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    if (justOn) data[SREG] &= ~I;
    tick();
    if (justOn) data[SREG] |= I;
  };
}
