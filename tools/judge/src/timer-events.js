// avr8js updates a timer at every count, which takes nearly all of the simulation's time. Here a timer is updated only
// when its next flag is due, and before the program reads or changes the timer. Only the speed differs; a test compares
// both methods.

/** Returns the cycle at which a running timer sets its next flag or wraps. */
function computeNextFlagCycle(timer) {
  const { tcnt, TOP, lastCycle, divider } = timer;
  let counts = TOP + 1 - tcnt;
  for (const compare of [timer.ocrA, timer.ocrB]) {
    if (compare > tcnt && compare - tcnt < counts) counts = compare - tcnt;
  }
  // A counter is beyond its TOP if TOP was lowered; avr8js wraps the counter at the next count.
  return lastCycle + Math.max(counts, 1) * divider;
}

/** Updates the timers of an Uno only when a flag is due. */
export function wakeTimersAtTheirFlags({ cpu, timers }) {
  const timerByCallback = new Map(timers.map((timer) => [timer.count, timer]));
  const addClockEvent = cpu.addClockEvent.bind(cpu);
  cpu.addClockEvent = (callback, cycles) => {
    const timer = timerByCallback.get(callback);
    const isCountingSteadily = timer?.divider && !timer.updateDivider && !timer.tcntUpdated;
    return addClockEvent(callback, isCountingSteadily ? computeNextFlagCycle(timer) - cpu.cycles : cycles);
  };
  for (const timer of timers) {
    const { OCRA, OCRB, TCNT, TCCRA, ICR } = timer.config;
    for (const register of [OCRA, OCRB, TCNT, TCCRA, ICR].filter(Boolean)) {
      const writeRegister = cpu.writeHooks[register];
      cpu.writeHooks[register] = (...args) => {
        if (timer.divider) timer.count(false);
        const isHandled = writeRegister(...args);
        if (timer.divider) cpu.updateClockEvent(timer.count, 1);
        return isHandled;
      };
    }
  }
}
