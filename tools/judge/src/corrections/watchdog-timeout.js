// A write to WDTCSR restarts the watchdog with the new timeout. avr8js first waits for the end of the old timeout, so a
// change from 1 s to 16 ms takes effect up to 1 s late.

export function applyNewWatchdogTimeout({ cpu, watchdog }) {
  const { WDTCSR } = watchdog.config;
  const writeRegister = cpu.writeHooks[WDTCSR];
  cpu.writeHooks[WDTCSR] = (...args) => {
    const isHandled = writeRegister(...args);
    while (cpu.clearClockEvent(watchdog.checkWatchdog));
    if (watchdog.enabled) cpu.addClockEvent(watchdog.checkWatchdog, watchdog.watchdogTimeout - cpu.cycles);
    return isHandled;
  };
}
