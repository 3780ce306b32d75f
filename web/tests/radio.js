// A Bluetooth module in Chromium's own emulation, with a simulated UNO at its serial line. The emulation delivers what
// the page writes. It has no notifications, so the robot's bytes reach the page as the event that a notification would
// cause.
import { devTools, openForbidden, page as openPage, within } from './browser.js';

const uuidOf = (shortId) => `0000${shortId}-0000-1000-8000-00805f9b34fb`;
export const HM10 = { name: 'HMSoft', service: uuidOf('ffe0'), to: 'ffe1', characteristics: { [uuidOf('ffe1')]: ['notify', 'writeWithoutResponse'] } };
export const NORDIC = {
  name: 'Bluefruit',
  service: '6e400001-b5a3-f393-e0a9-e50e24dcca9e',
  characteristics: { '6e400002-b5a3-f393-e0a9-e50e24dcca9e': ['write'], '6e400003-b5a3-f393-e0a9-e50e24dcca9e': ['notify'] },
};
const ADDRESS = '09:09:09:09:09:09';
const CONFIGURATION = '00002902-0000-1000-8000-00805f9b34fb';
/** The error of a missing module. */
const MISSING_MODULE = 0x3e;
/** Interval at which the radio is polled, ms of page time. */
const STEP_MS = 20;

/** Runs in the page before anything else. */
function initScript() {
  const { prototype } = BluetoothRemoteGATTCharacteristic;
  const { startNotifications } = prototype;
  prototype.startNotifications = function () {
    window.notifier = this;
    return startNotifications.call(this);
  };
  window.written = 0;
  for (const name of ['writeValueWithResponse', 'writeValueWithoutResponse']) {
    const write = prototype[name];
    prototype[name] = function (bytes) {
      window.written += 1;
      return write.call(this, bytes);
    };
  }
  window.say = (bytes) => {
    if (!window.inReach || !window.notifier) return;
    const value = new DataView(Uint8Array.from(bytes).buffer);
    Object.defineProperty(window.notifier, 'value', { value, configurable: true });
    window.notifier.dispatchEvent(new Event('characteristicvaluechanged'));
  };
  window.powerOn = () => {
    const { link, image } = window.lizard;
    const board = new link.board.constructor(image, null, null);
    // A new module, with its default name.
    board.baud = 9600;
    board.run(16_000 * 4000);
    const output = [];
    board.onByte = (byte) => output.push(byte);
    window.moved = 0;
    window.boardMs = () => board.cycle / 16_000;
    const widths = {};
    const pins = window.lizard.description.servos.map(({ pin }) => pin);
    board.onPulse = (pin, rise, width) => {
      if (pins.includes(pin) && Math.abs(widths[pin] - width) > 16) {
        window.moved = performance.now();
        window.movedAt = window.boardMs();
      }
      widths[pin] = width;
    };
    window.heard = '';
    board.onReceived = (byte) => (window.heard += String.fromCharCode(byte));
    setInterval(() => {
      board.run(16_000 * 2);
      while (output.length > 0) window.say(output.splice(0, 20));
    }, 2);
    window.otherBoard = board;
  };
}

export class Radio {
  /** Writes that the emulation has delivered, and their lengths. */
  packets = [];
  /** True while the module is in reach. */
  isInReach = true;

  constructor(opened, root, prompts, module) {
    Object.assign(this, { opened, root, prompts, module });
  }

  /**
   * Opens the page with such a module in reach; `adapter` is the state of the browser's radio, `allowed` its permission
   * to use it.
   */
  static async near(module, { adapter = 'powered-on', robot = true, allowed = true } = {}) {
    const page = allowed ? await openPage({}, initScript) : await openForbidden('bluetooth', initScript);
    const root = await devTools();
    await root.send('BluetoothEmulation.enable', { state: adapter, leSupported: true });
    const radio = new Radio(page, root, await page.context().newCDPSession(page), module);
    if (robot) await page.evaluate(() => window.powerOn());
    if (adapter !== 'powered-on') return radio;
    const { name, service } = module;
    await root.send('BluetoothEmulation.simulatePreconnectedPeripheral', { address: ADDRESS, name, manufacturerData: [], knownServiceUuids: [service] });
    // A failure after the page was closed does not matter; an earlier one shows as a test that times out.
    root.on('BluetoothEmulation.gattOperationReceived', (event) => radio.gatt(event).catch(() => {}));
    root.on('BluetoothEmulation.characteristicOperationReceived', (event) => radio.characteristic(event).catch(() => {}));
    await radio.prompts.send('DeviceAccess.enable');
    return radio;
  }

  async gatt({ type }) {
    if (type === 'discovery') await this.offer();
    if (type === 'connection' && this.isInReach) await this.reached();
    const code = this.isInReach ? 0 : MISSING_MODULE;
    await this.root.send('BluetoothEmulation.simulateGATTOperationResponse', { address: ADDRESS, type, code }).catch(() => {});
  }

  /** Sends the text that an HM-10 sends to the robot when its link changes, without a line end. */
  async reached() {
    await this.opened.evaluate(() => {
      window.inReach = true;
      window.otherBoard?.send([...'OK+CONN'].map((letter) => letter.charCodeAt(0)));
    });
  }

  async offer() {
    const { serviceId } = await this.root.send('BluetoothEmulation.addService', { address: ADDRESS, serviceUuid: this.module.service });
    for (const [characteristicUuid, propertyNames] of Object.entries(this.module.characteristics)) {
      const properties = Object.fromEntries(propertyNames.map((name) => [name, true]));
      const { characteristicId } = await this.root.send('BluetoothEmulation.addCharacteristic', { serviceId, characteristicUuid, properties });
      if (properties.notify) await this.root.send('BluetoothEmulation.addDescriptor', { characteristicId, descriptorUuid: CONFIGURATION });
    }
  }

  async characteristic({ characteristicId, type, data, writeType }) {
    if (type === 'write') {
      const bytes = [...Buffer.from(data, 'base64')];
      await this.opened.evaluate((bytes) => window.inReach && window.otherBoard?.send(bytes), bytes);
      this.packets.push(bytes.length);
    }
    if (writeType === 'write-without-response') return;
    await this.root.send('BluetoothEmulation.simulateCharacteristicOperationResponse', { characteristicId, type, code: 0 }).catch(() => {});
  }

  /** Advances the page's clock; writes arrive within the step in which they were made. */
  async run(ms) {
    for (let remainingMs = ms; remainingMs > 0; remainingMs -= STEP_MS) {
      await this.opened.clock.runFor(STEP_MS);
      const waitForArrival = async () => {
        while (this.isInReach && (await this.opened.evaluate(() => window.written)) > this.packets.length) await new Promise((resolve) => setTimeout(resolve, 5));
      };
      await within('packets to arrive', waitForArrival());
    }
  }

  async until(waitName, isSo) {
    let isWaiting = true;
    const advance = async () => {
      while (isWaiting && !(await isSo())) await this.run(STEP_MS);
    };
    await within(waitName, advance()).finally(() => (isWaiting = false));
  }

  /** Presses the button and picks the module, or none. */
  async pick(isPicked = true) {
    const prompt = new Promise((resolve) => this.prompts.once('DeviceAccess.deviceRequestPrompted', resolve));
    await this.opened.locator('#radio').click();
    const { id, devices } = await within('the browser to ask', prompt);
    if (isPicked) await this.prompts.send('DeviceAccess.selectPrompt', { id, deviceId: devices[0].id });
    else await this.prompts.send('DeviceAccess.cancelPrompt', { id });
  }

  /** Simulates a phone that sleeps: the page's timers stop, while the robot goes on. */
  async sleep(ms) {
    await this.opened.evaluate((ms) => {
      for (let remainingMs = ms; remainingMs > 0; remainingMs -= 2) window.otherBoard.run(16_000 * 2);
    }, ms);
  }

  /** Takes the module out of reach. */
  async cut() {
    this.isInReach = false;
    await this.opened.evaluate(() => {
      window.inReach = false;
      window.otherBoard.send([...'OK+LOST'].map((letter) => letter.charCodeAt(0)));
    });
    await this.root.send('BluetoothEmulation.simulateGATTDisconnection', { address: ADDRESS });
  }

  async back() {
    // Failed writes are not delivered.
    await this.opened.evaluate((count) => (window.written = count), this.packets.length);
    this.isInReach = true;
  }

  async end() {
    await this.root.send('BluetoothEmulation.disable');
  }
}
