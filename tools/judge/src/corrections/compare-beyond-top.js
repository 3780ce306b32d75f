// A counter never reaches a compare value beyond its top. avr8js treats the wrap as a match and sets OCF1B whenever
// the counter restarts.

export function ignoreCompareBeyondTop({ timers }) {
  for (const timer of timers) {
    const timerUpdated = timer.timerUpdated.bind(timer);
    timer.timerUpdated = (value, oldValue) => {
      const { ocrB } = timer;
      // NaN is neither less nor greater than a number, so it never matches.
      if (ocrB > timer.TOP) timer.ocrB = NaN;
      timerUpdated(value, oldValue);
      timer.ocrB = ocrB;
    };
  }
}
