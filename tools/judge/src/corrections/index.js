// The corrections of avr8js 0.21.1. Their order matters: each may wrap functions that an earlier correction replaced.
import { wakeTimersAtTheirFlags } from '../timer-events.js';
import { ignoreCompareBeyondTop } from './compare-beyond-top.js';
import { keepTransmitInterruptPending } from './data-register-empty.js';
import { handleAllDueEvents } from './due-events.js';
import { holdEepromInterrupt } from './eeprom-ready.js';
import { extendInterruptEntry } from './interrupt-entry.js';
import { delayInterruptAfterEnable } from './interrupt-waits.js';
import { simulateSleep } from './sleep.js';
import { addTransmitBuffer } from './transmit-buffer.js';
import { keepWaitingByte } from './waiting-byte.js';

export const corrections = [
  ignoreCompareBeyondTop,
  keepTransmitInterruptPending,
  keepWaitingByte,
  addTransmitBuffer,
  holdEepromInterrupt,
  wakeTimersAtTheirFlags,
  handleAllDueEvents,
  extendInterruptEntry,
  delayInterruptAfterEnable,
  simulateSleep,
];
