// A boot loader writes the part of flash that it does not run from, page by page (data sheet, chapter 26). avr8js
// treats SPM as a NOP. Here an erase and a write take no time, so a loader's wait for their end is short.
import { avrInstruction } from 'avr8js';

const SPM = 0x95e8;
const SPMCSR = 0x57;
const COMMAND = 0x1f;
const FILL = 0x01;
const ERASE = 0x03;
const WRITE = 0x05;
const PAGE_BYTES = 128;
const Z = 30;

export function selfProgramming(uno) {
  const { flash } = uno;
  const page = new Uint8Array(PAGE_BYTES).fill(0xff);
  const execute = (cpu) => {
    const { data } = cpu;
    avrInstruction(cpu);
    const address = data[Z] | (data[Z + 1] << 8);
    const start = address & ~(PAGE_BYTES - 1) & (flash.length - 1);
    switch (data[SPMCSR] & COMMAND) {
      case FILL:
        page.set(data.subarray(0, 2), address & (PAGE_BYTES - 2));
        break;
      case ERASE:
        flash.fill(0xff, start, start + PAGE_BYTES);
        break;
      case WRITE:
        // A cell can only be cleared; a set bit needs an erase.
        page.forEach((byte, index) => (flash[start + index] &= byte));
        page.fill(0xff);
        break;
    }
    data[SPMCSR] &= ~COMMAND;
  };
  uno.executeBy(execute, (opcode) => opcode === SPM);
}
