// avr8js counts a timer on every cycle that it steps, which is nearly all of its work. Here a timer
// is updated only when its next flag is due, and before it is read or changed.
// That changes nothing but the speed; a test compares the two.

/** Returns the cycle at which a running timer next sets a flag or wraps. */
function nextFlagCycle(timer) {
  const { tcnt, TOP, lastCycle, divider } = timer;
  let ticks = TOP + 1 - tcnt;
  for (const compare of [timer.ocrA, timer.ocrB]) {
    if (compare > tcnt && compare - tcnt < ticks) ticks = compare - tcnt;
  }
  // A counter beyond its TOP, which was lowered: avr8js wraps it at the next step.
  return lastCycle + Math.max(ticks, 1) * divider;
}

/** Updates the timers of an Uno only when a flag is due. */
export function wakeTimersAtTheirFlags({ cpu, timers }) {
  const timerOf = new Map(timers.map((timer) => [timer.count, timer]));
  const addClockEvent = cpu.addClockEvent.bind(cpu);
  cpu.addClockEvent = (callback, cycles) => {
    const timer = timerOf.get(callback);
    const isSteady = timer?.divider && !timer.updateDivider && !timer.tcntUpdated;
    return addClockEvent(callback, isSteady ? nextFlagCycle(timer) - cpu.cycles : cycles);
  };
  for (const timer of timers) {
    const { OCRA, OCRB, TCNT, TCCRA, ICR } = timer.config;
    for (const register of [OCRA, OCRB, TCNT, TCCRA, ICR].filter(Boolean)) {
      const write = cpu.writeHooks[register];
      cpu.writeHooks[register] = (...args) => {
        if (timer.divider) timer.count(false);
        const isWritten = write(...args);
        if (timer.divider) cpu.updateClockEvent(timer.count, 1);
        return isWritten;
      };
    }
  }
}
