// The receiver holds two bytes, and a third waits in its shift register (data sheet, 19.7.1); further bytes
// are lost. avr8js holds one. A boot loader that blinks before it reads needs the others.
const RXEN = 0x10;
const RXC = 0x80;
const FE = 0x10;
const HOLDS = 3;

/**
 * Adds `receive(byte, isGarbled)` to an Uno, for a byte that arrives on the serial line, garbled if it has no stop bit; it
 * returns false if the byte is lost.
 */
export function receiveBuffer(uno) {
  const { cpu, usart } = uno;
  const { UCSRA, UCSRB, UDR } = usart.config;
  const waiting = [];
  const on = () => cpu.data[UCSRB] & RXEN;
  const full = () => cpu.data[UCSRA] & RXC;
  const show = ([byte, isGarbled]) => {
    cpu.data[UCSRA] = isGarbled ? cpu.data[UCSRA] | FE : cpu.data[UCSRA] & ~FE;
    usart.writeByte(byte, true);
  };
  const read = cpu.readHooks[UDR];
  cpu.readHooks[UDR] = (...args) => {
    const byte = read(...args);
    if (waiting.length > 0) show(waiting.shift());
    return byte;
  };
  uno.receive = (byte, isGarbled = false) => {
    if (!on()) {
      waiting.length = 0;
      return false;
    }
    if (!full()) show([byte, isGarbled]);
    else if (waiting.length + 1 < HOLDS) waiting.push([byte, isGarbled]);
    else return false;
    return true;
  };
}
