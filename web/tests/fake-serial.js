// A replacement for Web Serial whose only port is a second simulated UNO; runs in the page before anything else.

/**
 * Replaces Web Serial. A test may set these properties of `window`:
 * - `flashedRobot`: name of the robot in the board's flash, or null for an erased flash;
 * - `isSameBoard`: true to open the previous board again;
 * - `boardKeepsRunning`: true for a board that has run for four seconds and that its port does not reset;
 * - `boardSendsGarbage`: true for a board that sends random bytes;
 * - `loaderBaud`: baud rate of the boot loader, if it differs from the firmware's;
 * - `usbVendor`: USB vendor of the board's chip;
 * - `bluetoothService` and `moduleBaud`: Bluetooth service and baud rate of a port that is a Bluetooth module;
 * - `onPortPick` and `onPortOpen`: functions that are called before the port is picked or opened, and may throw.
 *
 * A test may read the simulated board from `attachedBoard`, the bytes that the board received from `receivedText`, the
 * last pulse width at each pin from `pulseWidthsUs`, and the last request for a port from `portRequest`; `unplug`
 * simulates the loss of the port.
 */
export function installFakeSerial() {
  let board;
  const makeImage = async (robotName) => {
    const { wasm, image } = window.lizard.robot;
    // A second instance, so that the page's own robot stays unchanged.
    const secondRobot = new wasm.constructor();
    const { start } = secondRobot.load(await (await fetch(`files/${robotName}.toml`)).text());
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
      window.onPortOpen?.();
      // The page opens a port again to change its baud rate.
      const isSameBoard = window.isSameBoard || (board && (baudRate !== 115_200 || port.baudRate !== 115_200));
      port.baudRate = baudRate;
      const { board: pageBoard } = window.lizard.board.link;
      const robotName = window.flashedRobot === undefined ? 'robot' : window.flashedRobot;
      if (!isSameBoard) board = new pageBoard.constructor(robotName && (await makeImage(robotName)), new Uint8Array(await (await fetch('files/optiboot.bin')).arrayBuffer()));
      if (window.moduleBaud) board.baud = window.moduleBaud;
      // Bytes sent before the port is open are lost.
      if (window.boardKeepsRunning) board.run(16_000 * 4000);
      let output;
      port.readable = new ReadableStream({ start: (controller) => (output = controller) });
      window.unplug = () => {
        clearInterval(port.timer);
        port.readable = null;
        output.error(new Error('The device has been lost.'));
      };
      // The boot loader begins at the word address 0x3f00.
      const isBaudRight = () => baudRate === (board.uno.cpu.pc >= 0x3f00 ? (window.loaderBaud ?? 115_200) : 115_200);
      port.writable = new WritableStream({ write: (bytes) => (isBaudRight() ? board.send(bytes) : undefined) });
      board.onByte = (byte) => (isBaudRight() ? output.enqueue(Uint8Array.of(byte)) : undefined);
      if (window.boardSendsGarbage) {
        board.send = () => {};
        board.onByte = () => {};
      }
      let seed = 1;
      const randomByte = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 16) & 0xff;
      window.pulseWidthsUs = {};
      board.onPulse = (pin, rise, width) => (window.pulseWidthsUs[pin] = width / 16);
      if (!window.boardKeepsRunning) board.reset('external');
      window.attachedBoard = board;
      window.receivedText = '';
      board.onReceived = (byte) => (window.receivedText += String.fromCharCode(byte));
      port.timer = setInterval(() => {
        if (window.boardSendsGarbage) output.enqueue(Uint8Array.from({ length: 20 }, randomByte));
        board.run(16_000 * 2);
      }, 2);
    },
    getInfo: () => (window.bluetoothService ? { bluetoothServiceClassId: window.bluetoothService } : { usbVendorId: window.usbVendor ?? 0x2341 }),
    async setSignals({ dataTerminalReady }) {
      if (dataTerminalReady && !window.boardKeepsRunning) board.reset('external');
    },
    close: async () => clearInterval(port.timer),
  };
  const requestPort = async (options) => {
    window.portRequest = options;
    window.onPortPick?.();
    return port;
  };
  Object.defineProperty(navigator, 'serial', { value: { requestPort } });
}
