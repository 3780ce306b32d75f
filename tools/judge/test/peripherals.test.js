// Peripherals other than the timers and the serial line: behaviour that firmware may rely on in this simulation, and
// cases that avr8js cannot simulate.
import assert from 'node:assert/strict';
import test from 'node:test';

import { corrections } from '../src/corrections/index.js';
import { makeUno, runProgram } from './program.js';

const CYCLES_PER_MS = 16_000;

/** Writes r16 to EEPROM address 5, counts in r25:r24 while EEPE is set, and reads the byte back into r17. */
const WRITE_PROGRAM = `
    ldi r16, 0x5a
    ldi r18, 5
    out 0x21, r18     ; EEARL
    out 0x20, r16     ; EEDR
    sbi 0x1f, 2       ; EEMPE
    sbi 0x1f, 1       ; EEPE
  wait:
    adiw r24, 1
    sbic 0x1f, 1
    rjmp wait
    sbi 0x1f, 0       ; EERE
    in r17, 0x20
  stop:
    rjmp stop`;

test('an EEPROM byte takes 3.4 ms to write and can be read back', () => {
  const board = runProgram(corrections, WRITE_PROGRAM, 5 * CYCLES_PER_MS);
  const { data } = board.cpu;
  // One iteration of the loop takes five cycles.
  const busyCycles = (data[24] + 256 * data[25]) * 5;
  assert.ok(Math.abs(busyCycles - 3.4 * CYCLES_PER_MS) < 20, `${busyCycles} cycles`);
  assert.equal(data[17], 0x5a);
  assert.deepEqual([...board.eeprom.backend.memory.slice(4, 7)], [0xff, 0x5a, 0xff]);
});

test('setting EEPE too long after EEMPE writes nothing', () => {
  const lateProgram = WRITE_PROGRAM.replace('sbi 0x1f, 1 ', 'nop\n nop\n nop\n nop\n sbi 0x1f, 1 ');
  assert.equal(runProgram(corrections, lateProgram, 5 * CYCLES_PER_MS).eeprom.backend.memory[5], 0xff);
});

test('the bandgap reference measured against 5 V reads 225', () => {
  const { data } = runProgram(corrections, `
      ldi r16, 0x4e
      sts 0x7c, r16     ; ADMUX: AVcc, 1.1 V
      ldi r16, 0xc7
      sts 0x7a, r16     ; ADCSRA: on, start, clock / 128
    wait:
      adiw r24, 1
      lds r17, 0x7a
      sbrc r17, 6       ; ADSC
      rjmp wait
      lds r18, 0x78     ; ADCL
      lds r19, 0x79     ; ADCH
    stop:
      rjmp stop`, CYCLES_PER_MS).cpu;
  assert.equal(data[18] + 256 * data[19], 225);
  // The first conversion takes 25 cycles of the ADC clock; one iteration of the loop takes seven cycles.
  assert.ok(Math.abs((data[24] + 256 * data[25]) * 7 - 25 * 128) < 20);
});

/** A program that sets the watchdog to interrupt after 16 ms and then reset; the handler counts its calls in r20. */
const watchdogProgram = (loop) => `
    jmp main
    _LOC 0x18         ; WDT
    inc r20
    reti
    _LOC 0x68
  main:
    ldi r16, 0x18
    ldi r17, 0x48
    sts 0x60, r16     ; WDTCSR: WDCE, WDE
    sts 0x60, r17     ; WDIE, WDE
    sei
  again:
    ${loop}
    rjmp again`;

test('a watchdog that is fed does not interrupt', () => {
  assert.equal(runProgram(corrections, watchdogProgram('wdr'), 100 * CYCLES_PER_MS).cpu.data[20], 0);
});

test('a watchdog that is not fed interrupts after 16 ms', () => {
  assert.equal(runProgram(corrections, watchdogProgram('nop'), 15 * CYCLES_PER_MS).cpu.data[20], 0);
  assert.equal(runProgram(corrections, watchdogProgram('nop'), 17 * CYCLES_PER_MS).cpu.data[20], 1);
});

test('a watchdog reset ends the run', () => {
  const board = makeUno(corrections, watchdogProgram('nop'));
  assert.throws(() => board.run(40 * CYCLES_PER_MS), /^Error: the watchdog resets the UNO at cycle 51\d{4}, /);
});

test('a byte that would overrun the last one ends the run', () => {
  const board = makeUno(corrections, 'ldi r16, 0x10\n sts 0xc1, r16\n again: rjmp again');
  board.scheduleBytes([{ cycle: 100, byte: 1 }, { cycle: 1500, byte: 2 }]);
  assert.throws(() => board.run(2000), /^Error: at cycle 150\d a byte arrives before the last one was read/);
});
