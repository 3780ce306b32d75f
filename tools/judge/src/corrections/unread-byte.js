// A receiver drops an unread byte only when it is switched off (data sheet, 20.7.6). avr8js also drops the byte when
// the program writes UCSR0B while the receiver stays on, for example to enable the transmit interrupt.
const RXC = 0x80;
const RXEN = 0x10;

export function keepUnreadByte({ cpu, usart }) {
  const { UCSRA, UCSRB } = usart.config;
  const writeRegister = cpu.writeHooks[UCSRB];
  cpu.writeHooks[UCSRB] = (value, ...rest) => {
    const hasUnreadByte = cpu.data[UCSRA] & RXC && value & RXEN;
    const isHandled = writeRegister(value, ...rest);
    if (hasUnreadByte) cpu.setInterruptFlag(usart.RXC);
    return isHandled;
  };
}
