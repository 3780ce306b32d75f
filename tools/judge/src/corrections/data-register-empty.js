// The transmit interrupt comes as long as the transmitter has room (data sheet, 19.7.3: UDRE0 falls only
// when UDR0 is written). avr8js clears UDRE0 when it calls the handler, so a handler that has nothing
// to send, and whose writer enables the interrupt a moment later, is never called again.

export function dataRegisterEmpty({ usart }) {
  usart.UDRE.constant = true;
}
