// The receiver holds two bytes, and a third waits in its shift register (data sheet, 19.7.1); further bytes
// are lost. avr8js holds one. A boot loader that blinks before it reads needs the others.
const RXEN = 0x10;
const RXC = 0x80;
const FE = 0x10;
const CAPACITY = 3;

/**
 * Adds `receive(byte, isGarbled)` to an Uno, for a byte that arrives on the serial line, garbled if it has no stop bit; it
 * returns false if the byte is lost.
 */
export function receiveBuffer(uno) {
  const { cpu, usart } = uno;
  const { UCSRA, UCSRB, UDR } = usart.config;
  const waitingBytes = [];
  const isOn = () => cpu.data[UCSRB] & RXEN;
  const isFull = () => cpu.data[UCSRA] & RXC;
  const show = ([byte, isGarbled]) => {
    cpu.data[UCSRA] = isGarbled ? cpu.data[UCSRA] | FE : cpu.data[UCSRA] & ~FE;
    usart.writeByte(byte, true);
  };
  const read = cpu.readHooks[UDR];
  cpu.readHooks[UDR] = (...args) => {
    const byte = read(...args);
    if (waitingBytes.length > 0) show(waitingBytes.shift());
    return byte;
  };
  uno.receive = (byte, isGarbled = false) => {
    if (!isOn()) {
      waitingBytes.length = 0;
      return false;
    }
    if (!isFull()) show([byte, isGarbled]);
    else if (waitingBytes.length + 1 < CAPACITY) waitingBytes.push([byte, isGarbled]);
    else return false;
    return true;
  };
}
