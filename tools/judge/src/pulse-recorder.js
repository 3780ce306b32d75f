/** Arduino's pin number of each port's bit 0. Port D has D0 to D7, B has D8 to D13, C has A0 to A5 as 14 to 19. */
const FIRST_PIN = { D: 0, B: 8, C: 14 };

/**
 * Watches the pins of an Uno like an oscilloscope. Calls `onPulse(pin, rise, width)` when a pulse ends; `rise` is the
 * cycle of the rising edge, and `width` is in cycles.
 */
export function recordPulses(uno, onPulse) {
  const riseCycles = [];
  const changes = [];
  for (const [portName, port] of Object.entries(uno.ports)) {
    port.addListener((value, oldValue) => {
      changes.push({ firstPin: FIRST_PIN[portName], value, oldValue });
      uno.hasPortChanged = true;
    });
  }
  // An edge gets the cycle at which its instruction ends.
  uno.afterPortChange = () => {
    for (const { firstPin, value, oldValue } of changes) {
      for (let bit = 0; bit < 8; bit++) {
        if (!(((value ^ oldValue) >> bit) & 1)) continue;
        const pin = firstPin + bit;
        if ((value >> bit) & 1) {
          riseCycles[pin] = uno.cpu.cycles;
        } else if (riseCycles[pin] !== undefined) {
          onPulse(pin, riseCycles[pin], uno.cpu.cycles - riseCycles[pin]);
        }
      }
    }
    changes.length = 0;
  };
}
