// A compare value beyond the counter's top is never reached. avr8js treats the wrap as a match, and sets
// OCF1B each time that the counter restarts.

export function compareBeyondTop({ timers }) {
  for (const timer of timers) {
    const timerUpdated = timer.timerUpdated.bind(timer);
    timer.timerUpdated = (value, previous) => {
      const { ocrB } = timer;
      // NaN is neither less nor more than anything: it never matches.
      if (ocrB > timer.TOP) timer.ocrB = NaN;
      timerUpdated(value, previous);
      timer.ocrB = ocrB;
    };
  }
}
