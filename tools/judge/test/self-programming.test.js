import assert from 'node:assert/strict';
import test from 'node:test';

import { addSelfProgramming } from '../src/self-programming.js';
import { runProgram } from './program.js';

// Fills the first word of the page buffer, erases the page at 0x200 if `erasesPage`, and writes the page.
const program = (erasesPage) => `
    ldi r30, 0x00
    ldi r31, 0x02
    ldi r16, 0x34
    mov r0, r16
    ldi r16, 0x12
    mov r1, r16
    ldi r16, 1
    out 0x37, r16     ; SPMCSR: fill
    spm
    ldi r16, ${erasesPage ? 3 : 0}
    out 0x37, r16     ; erase
    spm
    ldi r16, 5
    out 0x37, r16     ; write
    spm
    in r20, 0x37
  stop:
    rjmp stop`;

test('SPM fills, erases and writes a page', () => {
  const runForWords = (corrections) => runProgram(corrections, program(true), 100).cpu.progMem.subarray(0x100, 0x102);
  assert.equal(runForWords([])[0], 0xffff, 'avr8js now simulates SPM: remove self-programming.js');
  assert.deepEqual([...runForWords([addSelfProgramming])], [0x1234, 0xffff]);
});

test('SPMCSR reports the end of the operation', () => {
  assert.equal(runProgram([addSelfProgramming], program(true), 100).cpu.data[20] & 0x1f, 0);
});

test('a write without an erase only clears bits', () => {
  const presetByte = (board) => {
    board.flash[0x200] = 0xf0;
    addSelfProgramming(board);
  };
  assert.equal(runProgram([presetByte], program(false), 100).cpu.progMem[0x100] & 0xff, 0x30);
});
