// The corrections of avr8js 0.21.1. The order matters: each may wrap functions of the previous ones.
import { wakeTimersAtTheirFlags } from '../timer-events.js';
import { compareBeyondTop } from './compare-beyond-top.js';
import { dataRegisterEmpty } from './data-register-empty.js';
import { dueEvents } from './due-events.js';
import { eepromReady } from './eeprom-ready.js';
import { interruptEntry } from './interrupt-entry.js';
import { interruptWaits } from './interrupt-waits.js';
import { sleep } from './sleep.js';
import { transmitBuffer } from './transmit-buffer.js';
import { waitingByte } from './waiting-byte.js';

export const corrections = [
  compareBeyondTop,
  dataRegisterEmpty,
  waitingByte,
  transmitBuffer,
  eepromReady,
  wakeTimersAtTheirFlags,
  dueEvents,
  interruptEntry,
  interruptWaits,
  sleep,
];
