// Makes flash images of robots as the page does, from the page's own files.
import { readPageFile, Robot } from './wasm.js';

/** Address of the robot's section in the flash. */
export const SECTION_START = 0x6e00;

/** Makes the flash image for a robot file of the page. */
export async function makeImage(robotName) {
  const robot = new Robot();
  const { start } = robot.load(await readPageFile(`${robotName}.toml`, 'utf8'));
  const section = robot.section();
  const flash = new Uint8Array(32 * 1024).fill(0xff);
  flash.set(await readPageFile('code.bin'));
  flash.set(section, start);
  return flash.subarray(0, start + section.length);
}

/** Formats bytes from address 0 on as an Intel HEX file. */
export function formatHex(bytes) {
  const lines = [];
  for (let address = 0; address < bytes.length; address += 16) {
    const data = bytes.subarray(address, address + 16);
    const record = [data.length, address >> 8, address & 0xff, 0, ...data];
    const sum = record.reduce((total, byte) => total + byte, 0);
    lines.push(`:${[...record, -sum & 0xff].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`);
  }
  return [...lines, ':00000001FF', ''].join('\n');
}
