// The transmitter sends one byte and holds another (data sheet, 19.6): UDRE0 is up as long as there is no
// second one, and bytes go out back to back. avr8js holds one, so a gap follows each byte.

export function transmitBuffer({ cpu, usart }) {
  let busy = false;
  let next = null;
  const shift = (byte) => {
    busy = true;
    cpu.addClockEvent(() => {
      usart.onByteTransmit?.(byte);
      busy = false;
      if (next === null) {
        cpu.setInterruptFlag(usart.TXC);
      } else {
        shift(next);
        next = null;
        cpu.setInterruptFlag(usart.UDRE);
      }
    }, usart.cyclesPerChar);
  };
  cpu.writeHooks[usart.config.UDR] = (byte) => {
    if (!busy) {
      shift(byte);
    } else if (next === null) {
      next = byte;
      cpu.clearInterrupt(usart.UDRE);
    }
    return true;
  };
}
