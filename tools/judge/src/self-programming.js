// Adds the instruction SPM, which avr8js treats as a NOP: with it a boot loader erases and writes the flash outside its
// own section, page by page (data sheet, chapter 27). Here both take no time, so a loader that waits continues at once.
import { avrInstruction } from 'avr8js';

const SPM = 0x95e8;
const SPMCSR = 0x57;
const COMMAND_MASK = 0x1f;
const FILL_BUFFER = 0x01;
const ERASE_PAGE = 0x03;
const WRITE_PAGE = 0x05;
const PAGE_BYTES = 128;
const ZL = 30;
const ZH = 31;

export function addSelfProgramming(uno) {
  const { flash } = uno;
  const pageBuffer = new Uint8Array(PAGE_BYTES).fill(0xff);
  const execute = (cpu) => {
    const { data } = cpu;
    avrInstruction(cpu);
    const address = data[ZL] | (data[ZH] << 8);
    const pageStart = address & ~(PAGE_BYTES - 1) & (flash.length - 1);
    switch (data[SPMCSR] & COMMAND_MASK) {
      case FILL_BUFFER:
        pageBuffer.set(data.subarray(0, 2), address & (PAGE_BYTES - 2));
        break;
      case ERASE_PAGE:
        flash.fill(0xff, pageStart, pageStart + PAGE_BYTES);
        break;
      case WRITE_PAGE:
        // A write can only clear bits; only an erase sets them.
        pageBuffer.forEach((byte, index) => (flash[pageStart + index] &= byte));
        pageBuffer.fill(0xff);
        break;
    }
    data[SPMCSR] &= ~COMMAND_MASK;
  };
  uno.overrideInstructions(execute, (opcode) => opcode === SPM);
}
