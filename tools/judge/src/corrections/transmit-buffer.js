// The transmitter sends one byte and holds another (data sheet, 19.6): UDRE0 is set as long as there is no
// second one, and bytes are sent back to back. avr8js holds one, so a gap follows each byte.

export function transmitBuffer({ cpu, usart }) {
  let isBusy = false;
  let nextByte = null;
  // The line's own time: an event is seen only at the end of an instruction.
  let dueCycle;
  const shiftOut = (byte) => {
    isBusy = true;
    dueCycle += usart.cyclesPerChar;
    cpu.addClockEvent(() => {
      usart.onByteTransmit?.(byte, dueCycle);
      isBusy = false;
      if (nextByte === null) {
        cpu.setInterruptFlag(usart.TXC);
      } else {
        shiftOut(nextByte);
        nextByte = null;
        cpu.setInterruptFlag(usart.UDRE);
      }
    }, dueCycle - cpu.cycles);
  };
  cpu.writeHooks[usart.config.UDR] = (byte) => {
    if (!isBusy) {
      dueCycle = cpu.cycles;
      shiftOut(byte);
    } else if (nextByte === null) {
      nextByte = byte;
      cpu.clearInterrupt(usart.UDRE);
    }
    return true;
  };
}
