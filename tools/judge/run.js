// Runs firmware on avr8js: node run.js FIRMWARE.hex < SCRIPT
//
// src/script.js explains SCRIPT. Prints these lines; all cycles are counted from power-on:
//   pulse <pin> <rise> <width>   the pin was high for `width` cycles from cycle `rise`; pins 14 to 19 are A0 to A5
//   sent <cycle> <hex byte>      the UNO sent a byte, whose stop bit ended at this cycle
//   eeprom <2048 hex digits>     the EEPROM's contents at the end
//   cpu <ms>                     processor time of the simulation
// If the firmware does something that avr8js cannot simulate, the run ends with an error message and exit code 1.
import { readFileSync } from 'node:fs';

import { corrections } from './src/corrections/index.js';
import { loadHex } from './src/hex.js';
import { recordPulses } from './src/pulse-recorder.js';
import { parseScript } from './src/script.js';
import { Uno } from './src/uno.js';

const toHex = (byte) => byte.toString(16).padStart(2, '0');

function run(firmwarePath, script) {
  const uno = new Uno(corrections);
  loadHex(readFileSync(firmwarePath, 'utf8'), uno.flash);
  const { voltages, bytes, endCycle } = parseScript(script);
  for (const { channel, volts } of voltages) uno.adc.channelValues[channel] = volts;
  const lines = [];
  recordPulses(uno, (pin, rise, width) => lines.push(`pulse ${pin} ${rise} ${width}`));
  uno.usart.onByteTransmit = (byte, cycle) => lines.push(`sent ${cycle} ${toHex(byte)}`);
  uno.scheduleBytes(bytes);
  uno.run(endCycle);
  lines.push(`eeprom ${Array.from(uno.eepromBytes, toHex).join('')}`);
  return lines;
}

try {
  if (process.argv.length !== 3) throw new Error('usage: node run.js FIRMWARE.hex < SCRIPT');
  const usageBefore = process.cpuUsage();
  const lines = run(process.argv[2], readFileSync(0, 'utf8'));
  const { user, system } = process.cpuUsage(usageBefore);
  lines.push(`cpu ${Math.round((user + system) / 1000)}`);
  process.stdout.write(lines.join('\n') + '\n');
} catch (error) {
  console.error(`judge: ${error.message}`);
  process.exitCode = 1;
}
