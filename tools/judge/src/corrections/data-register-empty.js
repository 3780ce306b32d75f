// The transmit interrupt is pending as long as the transmitter has room (data sheet, 19.7.3: UDRE0 falls only
// when UDR0 is written). avr8js clears UDRE0 when it calls the handler. If the handler then has nothing to send,
// it is never called again, even if the program enables the interrupt a moment later.

export function keepTransmitInterruptPending({ usart }) {
  usart.UDRE.constant = true;
}
