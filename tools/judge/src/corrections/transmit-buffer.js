// The transmitter sends one byte and holds another (data sheet, 19.6): UDRE0 is set as long as there is no
// second one, and bytes are sent back to back. avr8js holds one, so a gap follows each byte.

export function transmitBuffer({ cpu, usart }) {
  let busy = false;
  let next = null;
  // The line's own time: an event is seen only at the end of an instruction.
  let due;
  const shift = (byte) => {
    busy = true;
    due += usart.cyclesPerChar;
    cpu.addClockEvent(() => {
      usart.onByteTransmit?.(byte, due);
      busy = false;
      if (next === null) {
        cpu.setInterruptFlag(usart.TXC);
      } else {
        shift(next);
        next = null;
        cpu.setInterruptFlag(usart.UDRE);
      }
    }, due - cpu.cycles);
  };
  cpu.writeHooks[usart.config.UDR] = (byte) => {
    if (!busy) {
      due = cpu.cycles;
      shift(byte);
    } else if (next === null) {
      next = byte;
      cpu.clearInterrupt(usart.UDRE);
    }
    return true;
  };
}
