// The corrections to avr8js 0.21.1. Their order matters: each may wrap functions that an earlier correction replaced.
import { wakeTimersAtTheirFlags } from '../timer-events.js';
import { ignoreCompareBeyondTop } from './compare-beyond-top.js';
import { keepTransmitInterruptPending } from './data-register-empty.js';
import { handleAllDueEvents } from './due-events.js';
import { holdEepromInterrupt } from './eeprom-ready.js';
import { delayInterruptAfterEnable } from './interrupt-after-enable.js';
import { extendInterruptEntry } from './interrupt-entry.js';
import { simulateSleep } from './sleep.js';
import { addTransmitBuffer } from './transmit-buffer.js';
import { keepUnreadByte } from './unread-byte.js';
import { applyNewWatchdogTimeout } from './watchdog-timeout.js';

export const corrections = [
  ignoreCompareBeyondTop,
  keepTransmitInterruptPending,
  keepUnreadByte,
  addTransmitBuffer,
  holdEepromInterrupt,
  wakeTimersAtTheirFlags,
  handleAllDueEvents,
  extendInterruptEntry,
  delayInterruptAfterEnable,
  simulateSleep,
  applyNewWatchdogTimeout,
];
