import assert from 'node:assert/strict';
import test from 'node:test';

import { addTransmitBuffer } from '../src/corrections/transmit-buffer.js';
import { formatFaultFixed, makeUno } from './program.js';

// The program sends three bytes at 1 Mbaud, 16 cycles per bit. It writes each byte as soon as UDRE0 is set, and copies
// the status after the first byte to r16.
const program = `
    ldi r18, 0x08
    sts 0xc1, r18     ; UCSR0B: transmitter
    ldi r18, 0x61
    sts 0xc6, r18     ; UDR0
    lds r16, 0xc0     ; UCSR0A
  next:
    inc r18
  wait:
    lds r17, 0xc0
    sbrs r17, 5       ; UDRE0
    rjmp wait
    sts 0xc6, r18
    cpi r18, 0x63
    brne next
  stop:
    rjmp stop`;

function transmit(corrections) {
  const board = makeUno(corrections, program);
  const bytes = [];
  board.usart.onByteTransmit = (byte, cycle) => bytes.push({ byte, cycle });
  board.run(1000);
  return { isBufferEmpty: ((board.cpu.data[16] >> 5) & 1) === 1, bytes };
}

test('the transmitter accepts a byte while it sends another', () => {
  assert.equal(transmit([]).isBufferEmpty, false, formatFaultFixed('transmit-buffer.js'));
  assert.equal(transmit([addTransmitBuffer]).isBufferEmpty, true);
});

test('bytes are sent back to back, ten bits each', () => {
  const { bytes } = transmit([addTransmitBuffer]);
  assert.deepEqual(bytes.map(({ byte }) => byte), [0x61, 0x62, 0x63]);
  assert.deepEqual([bytes[1].cycle - bytes[0].cycle, bytes[2].cycle - bytes[1].cycle], [160, 160]);
});
