// An oscilloscope on the UNO's pins.

/** Arduino's number of each port's bit 0: D0 to D7, D8 to D13, and 14 to 19 for A0 to A5. */
const FIRST_PIN = { D: 0, B: 8, C: 14 };

export class Scope {
  /** Watches the ports of an Uno; calls `onPulse(pin, rise, width)` when a pulse has ended. */
  constructor(uno, onPulse) {
    const rises = [];
    const changes = [];
    for (const [name, port] of Object.entries(uno.ports)) {
      port.addListener((now, before) => {
        changes.push({ first: FIRST_PIN[name], now, before });
        uno.hasChanged = true;
      });
    }
    // An edge belongs to the end of its instruction, whichever kind of store it is.
    uno.afterChange = () => {
      for (const { first, now, before } of changes) {
        for (let bit = 0; bit < 8; bit++) {
          if (!(((now ^ before) >> bit) & 1)) continue;
          const pin = first + bit;
          if ((now >> bit) & 1) {
            rises[pin] = uno.cpu.cycles;
          } else if (rises[pin] !== undefined) {
            onPulse(pin, rises[pin], uno.cpu.cycles - rises[pin]);
          }
        }
      }
      changes.length = 0;
    };
  }
}
