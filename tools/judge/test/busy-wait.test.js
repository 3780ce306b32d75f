import assert from 'node:assert/strict';
import test from 'node:test';

import { skipBusyWaits } from '../src/busy-wait.js';
import { corrections } from '../src/corrections/index.js';
import { addReceiveBuffer } from '../src/receive-buffer.js';
import { makeUno, readState, runProgram } from './program.js';

// The program waits for a byte, then twice for timer 1, each time with different instructions. It stores the byte and
// the timer's counts in SRAM from X on. Meanwhile, interrupts occur at varying intervals.
const PROGRAM = `
    jmp main
    _LOC 0x2c         ; TIMER1_COMPA
    lds r20, 0x84     ; TCNT1L
    st X+, r20
    lds r22, 0x88     ; OCR1AL
    subi r22, 0x6b
    sts 0x89, r18     ; OCR1AH
    sts 0x88, r22
    ldi r21, 252      ; takes so long that the next interrupt often waits
  late:
    dec r21
    brne late
    reti
    _LOC 0x68
  main:
    ldi r26, 0
    ldi r27, 1
    ldi r16, 0x10
    sts 0xc1, r16     ; UCSR0B: RXEN
    ldi r18, 3
    sts 0x89, r18     ; OCR1AH
    ldi r16, 5
    sts 0x88, r16     ; OCR1AL
    ldi r16, 1
    sts 0x8b, r16     ; OCR1BH
    sts 0x8a, r16     ; OCR1BL
    ldi r16, 2
    sts 0x6f, r16     ; TIMSK1
    ldi r16, 9
    sts 0x81, r16     ; TCCR1B: clear on match
    ldi r17, 4        ; OCF1B
    sei
  byte:
    lds r24, 0xc0     ; UCSR0A
    sbrs r24, 7
    rjmp byte
    lds r24, 0xc6     ; UDR0
    st X+, r24
    out 0x16, r17     ; TIFR1
  tested:
    sbis 0x16, 2
    rjmp tested
    lds r24, 0x84
    st X+, r24
    out 0x16, r17
  read:
    in r24, 0x16
    sbrs r24, 2
    rjmp read
    lds r24, 0x84
    st X+, r24
    rjmp byte`;

/** Runs the program while 40 bytes arrive; returns the board's state and the number of executed backward jumps. */
function runWithBytes(extraCorrections) {
  let jumpCount = 0;
  const countJumps = (board) => {
    const execute = board.executors.at(-1);
    board.executors[board.executors.length - 1] = (cpu) => {
      jumpCount += 1;
      execute(cpu);
    };
  };
  const extras = extraCorrections.length > 0 ? [...extraCorrections, countJumps] : [];
  const board = makeUno([...corrections, addReceiveBuffer, ...extras], PROGRAM);
  for (let byte = 1; byte <= 40; byte++) board.cpu.addClockEvent(() => board.receive(byte), 3989 * byte);
  board.run(170_001);
  return { ...readState(board), jumpCount };
}

test('skipping the iterations of flag loops does not change the state at a given cycle', () => {
  const [slow, { jumpCount, ...fast }] = [runWithBytes([]), runWithBytes([skipBusyWaits])];
  delete slow.jumpCount;
  for (let byte = 1; byte <= 40; byte++) assert.ok(slow.data.slice(0x100).includes(byte), `byte ${byte} must be read`);
  assert.deepEqual(fast, slow);
  assert.ok(jumpCount > 100 && jumpCount < 3000, `${jumpCount} backward jumps; without skipping, there are tens of thousands`);
});

test('a loop that waits for a count is not skipped', () => {
  const source = PROGRAM.replace('lds r24, 0xc0 ', 'lds r24, 0x84 ');
  assert.notEqual(source, PROGRAM);
  const [slow, fast] = [[], [skipBusyWaits]].map((extraCorrections) =>
    readState(runProgram([...corrections, addReceiveBuffer, ...extraCorrections], source, 50_001)),
  );
  assert.deepEqual(fast, slow);
});
