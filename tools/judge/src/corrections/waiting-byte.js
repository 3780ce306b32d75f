// Only a receiver that is switched off drops a byte that waits (data sheet, 19.8.5). avr8js drops it
// whenever UCSR0B is written while the receiver is on and stays on, say to enable the transmit interrupt.
const RXC = 0x80;
const RXEN = 0x10;

export function waitingByte({ cpu, usart }) {
  const { UCSRA, UCSRB } = usart.config;
  const write = cpu.writeHooks[UCSRB];
  cpu.writeHooks[UCSRB] = (value, ...rest) => {
    const isWaiting = cpu.data[UCSRA] & RXC && value & RXEN;
    const isWritten = write(value, ...rest);
    if (isWaiting) cpu.setInterruptFlag(usart.RXC);
    return isWritten;
  };
}
