// The transmit interrupt stays pending while the transmit buffer is empty: only a write to UDR0 clears UDRE0 (data
// sheet, 20.6.3). avr8js clears UDRE0 when it calls the handler. If the handler then has nothing to send, avr8js never
// calls it again, even if the program re-enables the interrupt a moment later.

export function keepTransmitInterruptPending({ usart }) {
  usart.UDRE.constant = true;
}
