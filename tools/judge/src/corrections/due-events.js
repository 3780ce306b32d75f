// All events that become due during an instruction are due at its end. avr8js handles one event
// and leaves the next to the next instruction, so that a byte delays a timer's flag.
const SREG = 0x5f;
const I = 0x80;

export function dueEvents({ cpu }) {
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const enabledBit = cpu.data[SREG] & I;
    // All events but the last, without interrupts, which are to see all of them.
    while (cpu.nextClockEvent?.next && cpu.nextClockEvent.next.cycles <= cpu.cycles) {
      cpu.data[SREG] &= ~I;
      tick();
    }
    cpu.data[SREG] |= enabledBit;
    tick();
  };
}
