// All events that become due during an instruction take effect at its end. avr8js handles one event per instruction and
// leaves the others for later instructions: if a serial byte and a timer's flag are due together, the byte delays the
// flag by one instruction.
const SREG = 0x5f;
const SREG_I = 0x80;

export function handleAllDueEvents({ cpu }) {
  const tick = cpu.tick.bind(cpu);
  cpu.tick = () => {
    const enabledBit = cpu.data[SREG] & SREG_I;
    // All due events but the last are handled with interrupts off, so that an interrupt sees the effects of all.
    while (cpu.nextClockEvent?.next && cpu.nextClockEvent.next.cycles <= cpu.cycles) {
      cpu.data[SREG] &= ~SREG_I;
      tick();
    }
    cpu.data[SREG] |= enabledBit;
    tick();
  };
}
