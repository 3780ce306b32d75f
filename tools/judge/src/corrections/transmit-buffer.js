// The transmitter buffers a second byte while it sends the first (data sheet, 20.6): UDRE0 is set while the buffer is
// empty, and bytes are sent back to back. avr8js has no buffer; therefore a gap follows each byte.

export function addTransmitBuffer({ cpu, usart }) {
  let isSending = false;
  let nextByte = null;
  // The cycle at which the stop bit ends; its event is handled later, at the end of an instruction.
  let byteEndCycle;
  const shiftOut = (byte) => {
    isSending = true;
    byteEndCycle += usart.cyclesPerChar;
    cpu.addClockEvent(() => {
      usart.onByteTransmit?.(byte, byteEndCycle);
      isSending = false;
      if (nextByte === null) {
        cpu.setInterruptFlag(usart.TXC);
      } else {
        shiftOut(nextByte);
        nextByte = null;
        cpu.setInterruptFlag(usart.UDRE);
      }
    }, byteEndCycle - cpu.cycles);
  };
  cpu.writeHooks[usart.config.UDR] = (byte) => {
    if (!isSending) {
      byteEndCycle = cpu.cycles;
      shiftOut(byte);
    } else if (nextByte === null) {
      nextByte = byte;
      cpu.clearInterrupt(usart.UDRE);
    }
    return true;
  };
}
