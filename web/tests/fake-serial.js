// A Web Serial whose one port is a second simulated UNO; runs in the page, before anything else.

/**
 * With `window.flashed` set to the name of a robot, or to null for an erased flash, the board has firmware and that one;
 * `window.same` has the port open the board that it had before;
 * `window.awake` has it run for four seconds and not be reset by its port; `window.pick` throws in place of a choice
 * of the port; `window.garbage` has the board say bytes without a meaning; `window.profile` is the Bluetooth service of a port that is no
 * cable; `window.baud` is the rate at which that port talks to the board. `window.pulses` has the last width of
 * each pin, us; `window.vendor` is the USB vendor of its chip.
 */
export function fakeSerial() {
  let board;
  const image = async (name) => {
    const { robot, image } = window.lizard;
    // Another one than the page's, which stays as it is.
    const other = await robot.constructor.load(await WebAssembly.compile(await (await fetch('files/lizard.wasm')).arrayBuffer()));
    const { start } = other.read(await (await fetch(`files/${name}.toml`)).text());
    const section = other.section();
    const whole = new Uint8Array(start + section.length);
    whole.set(image.subarray(0, start));
    whole.set(section, start);
    return whole;
  };
  const port = {
    readable: null,
    writable: null,
    async open() {
      window.openPort?.();
      const { board: first } = window.lizard.link;
      const name = window.flashed === undefined ? 'robot' : window.flashed;
      if (!window.same) board = new first.constructor(name && (await image(name)), await (await fetch('files/optiboot.hex')).text());
      if (window.baud) board.baud = window.baud;
      // Bytes that it sends before the port is open are lost.
      if (window.awake) board.run(16_000 * 4000);
      let out;
      port.readable = new ReadableStream({ start: (controller) => (out = controller) });
      window.unplug = () => {
        clearInterval(port.timer);
        clearInterval(port.noise);
        port.readable = null;
        out.error(new Error('The device has been lost.'));
      };
      port.writable = new WritableStream({ write: (bytes) => board.send(bytes) });
      board.onByte = (byte) => out.enqueue(Uint8Array.of(byte));
      if (window.garbage) {
        board.send = () => {};
        board.onByte = () => {};
        let seed = 1;
        const byte = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 16) & 0xff;
        port.noise = setInterval(() => out.enqueue(Uint8Array.from({ length: 20 }, byte)), 2);
      }
      window.pulses = {};
      board.onPulse = (pin, rise, width) => (window.pulses[pin] = width / 16);
      if (!window.awake) board.reset('external');
      window.otherBoard = board;
      window.heard = '';
      board.onReceived = (byte) => (window.heard += String.fromCharCode(byte));
      port.timer = setInterval(() => board.run(16_000 * 2), 2);
    },
    getInfo: () => (window.profile ? { bluetoothServiceClassId: window.profile } : { usbVendorId: window.vendor ?? 0x2341 }),
    async setSignals({ dataTerminalReady }) {
      if (dataTerminalReady && !window.awake) board.reset('external');
    },
    async close() {
      clearInterval(port.timer);
      clearInterval(port.noise);
    },
  };
  const requestPort = async (options) => {
    window.wanted = options;
    window.pick?.();
    return port;
  };
  Object.defineProperty(navigator, 'serial', { value: { requestPort } });
}
