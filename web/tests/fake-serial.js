// A replacement for Web Serial whose only port is a second simulated UNO; runs in the page before anything else.

/**
 * Replaces Web Serial. Properties of `window` set what a test wants: `flashed`, the robot's name after the firmware in
 * the board's flash, or null for an erased flash; `same`, true to open the previous board again; `awake`, true for a
 * board that has run for four seconds and is not reset by its port; `loaderBaud`, the baud rate of the boot loader, if
 * it is another than the firmware's; `pick`, a function that may throw instead of choosing the port; `garbage`, true
 * for a board that sends meaningless bytes; `profile`, the Bluetooth service of a port that is no cable; `baud`, that
 * port's rate; `vendor`, the USB vendor of the board's chip. `pulses` has the last width at each pin, us.
 */
export function fakeSerial() {
  let board;
  const makeImage = async (name) => {
    const { robot, image } = window.lizard;
    // A second instance, so that the page's own robot stays unchanged.
    const secondRobot = new robot.constructor();
    const { start } = secondRobot.read(await (await fetch(`files/${name}.toml`)).text());
    const section = secondRobot.section();
    const flash = new Uint8Array(start + section.length);
    flash.set(image.subarray(0, start));
    flash.set(section, start);
    return flash;
  };
  const port = {
    readable: null,
    writable: null,
    async open({ baudRate }) {
      window.openPort?.();
      // The page opens a port again to set its speed.
      const isSame = window.same || (board && (baudRate !== 115_200 || port.baudRate !== 115_200));
      port.baudRate = baudRate;
      const { board: pageBoard } = window.lizard.link;
      const name = window.flashed === undefined ? 'robot' : window.flashed;
      if (!isSame) board = new pageBoard.constructor(name && (await makeImage(name)), new Uint8Array(await (await fetch('files/optiboot.bin')).arrayBuffer()));
      if (window.baud) board.baud = window.baud;
      // Bytes sent before the port is open are lost.
      if (window.awake) board.run(16_000 * 4000);
      let output;
      port.readable = new ReadableStream({ start: (controller) => (output = controller) });
      window.unplug = () => {
        clearInterval(port.timer);
        clearInterval(port.noise);
        port.readable = null;
        output.error(new Error('The device has been lost.'));
      };
      const isHeard = () => baudRate === (board.uno.cpu.pc >= 0x3f00 ? (window.loaderBaud ?? 115_200) : 115_200);
      port.writable = new WritableStream({ write: (bytes) => (isHeard() ? board.send(bytes) : undefined) });
      board.onByte = (byte) => (isHeard() ? output.enqueue(Uint8Array.of(byte)) : undefined);
      if (window.garbage) {
        board.send = () => {};
        board.onByte = () => {};
        let seed = 1;
        const randomByte = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 16) & 0xff;
        port.noise = setInterval(() => output.enqueue(Uint8Array.from({ length: 20 }, randomByte)), 2);
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
