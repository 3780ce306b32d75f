// The receiver buffers two bytes, and a third waits in its shift register (data sheet, 20.7.4); further bytes are lost.
// avr8js holds one byte. A boot loader that blinks its LED before it reads relies on all three.
const RXEN = 0x10;
const RXC = 0x80;
const FE = 0x10;
const CAPACITY = 3;

/**
 * Adds `receive(byte, isGarbled)` to an Uno: it delivers a byte from the serial line. A garbled byte has no stop bit.
 * `receive` returns false if the byte is lost.
 */
export function addReceiveBuffer(uno) {
  const { cpu, usart } = uno;
  const { UCSRA, UCSRB, UDR } = usart.config;
  const waitingBytes = [];
  const isReceiverOn = () => cpu.data[UCSRB] & RXEN;
  const hasUnreadByte = () => cpu.data[UCSRA] & RXC;
  const loadRegisters = ([byte, isGarbled]) => {
    cpu.data[UCSRA] = isGarbled ? cpu.data[UCSRA] | FE : cpu.data[UCSRA] & ~FE;
    usart.writeByte(byte, true);
  };
  const readRegister = cpu.readHooks[UDR];
  cpu.readHooks[UDR] = (...args) => {
    const byte = readRegister(...args);
    if (waitingBytes.length > 0) loadRegisters(waitingBytes.shift());
    return byte;
  };
  uno.receive = (byte, isGarbled = false) => {
    if (!isReceiverOn()) {
      waitingBytes.length = 0;
      return false;
    }
    if (!hasUnreadByte()) loadRegisters([byte, isGarbled]);
    else if (waitingBytes.length + 1 < CAPACITY) waitingBytes.push([byte, isGarbled]);
    else return false;
    return true;
  };
}
