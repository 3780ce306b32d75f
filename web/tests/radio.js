// A Bluetooth module in Chromium's own emulation, with a simulated UNO at its serial line. The emulation delivers the
// bytes that the page writes. It has no notifications, so this file sends the robot's bytes to the page in the event
// that a notification would cause.
import { setTimeout as sleep } from 'node:timers/promises';

import { openDevTools, openForbidden, openPage, repeatUntil, withTimeout } from './browser.js';

const makeUuid = (shortId) => `0000${shortId}-0000-1000-8000-00805f9b34fb`;
export const HM10 = { name: 'HMSoft', service: makeUuid('ffe0'), characteristics: { [makeUuid('ffe1')]: ['notify', 'writeWithoutResponse'] } };
export const NORDIC = {
  name: 'Bluefruit',
  service: '6e400001-b5a3-f393-e0a9-e50e24dcca9e',
  characteristics: { '6e400002-b5a3-f393-e0a9-e50e24dcca9e': ['write'], '6e400003-b5a3-f393-e0a9-e50e24dcca9e': ['notify'] },
};
const MODULE_ADDRESS = '09:09:09:09:09:09';
const CONFIGURATION_DESCRIPTOR = '00002902-0000-1000-8000-00805f9b34fb';
/** Bluetooth error code of a module that is out of range. */
const OUT_OF_RANGE = 0x3e;
/** Interval at which written packets are awaited, ms of page time. */
const STEP_MS = 20;

/** Prepares the page; runs in it before any other script. */
function prepareRadio() {
  const { prototype } = BluetoothRemoteGATTCharacteristic;
  const { startNotifications } = prototype;
  prototype.startNotifications = function () {
    window.notifyingCharacteristic = this;
    return startNotifications.call(this);
  };
  window.writeCount = 0;
  for (const name of ['writeValueWithResponse', 'writeValueWithoutResponse']) {
    const write = prototype[name];
    prototype[name] = function (bytes) {
      window.writeCount += 1;
      return write.call(this, bytes);
    };
  }
  window.sendToPage = (bytes) => {
    if (!window.isInRange || !window.notifyingCharacteristic) return;
    const value = new DataView(Uint8Array.from(bytes).buffer);
    Object.defineProperty(window.notifyingCharacteristic, 'value', { value, configurable: true });
    window.notifyingCharacteristic.dispatchEvent(new Event('characteristicvaluechanged'));
  };
  window.powerOnBoard = () => {
    const { board: pageBoard, robot } = window.lizard;
    const board = new pageBoard.link.board.constructor(robot.image, null, null);
    // A new module has its default rate of 9600 baud.
    board.baud = 9600;
    board.run(16_000 * 4000);
    const output = [];
    board.onByte = (byte) => output.push(byte);
    window.lastMoveMs = 0;
    window.readBoardMs = () => board.cycle / 16_000;
    const widths = {};
    const pins = robot.description.servos.map(({ pin }) => pin);
    board.onPulse = (pin, rise, width) => {
      if (pins.includes(pin) && Math.abs(widths[pin] - width) > 16) {
        window.lastMoveMs = performance.now();
        window.lastMoveBoardMs = window.readBoardMs();
      }
      widths[pin] = width;
    };
    window.receivedText = '';
    board.onReceived = (byte) => (window.receivedText += String.fromCharCode(byte));
    setInterval(() => {
      board.run(16_000 * 2);
      while (output.length > 0) window.sendToPage(output.splice(0, 20));
    }, 2);
    window.attachedBoard = board;
  };
}

/** The page, and an emulated module that a test may take out of range. */
export class Radio {
  /** Lengths of the packets that the emulation has delivered. */
  packetLengths = [];
  isInRange = true;

  constructor(page, browserSession, pageSession, module) {
    Object.assign(this, { page, browserSession, pageSession, module });
  }

  /**
   * Opens the page with a module in range. `adapterState` is the state of the browser's radio; `hasRobot` is true if a
   * robot is at the module's serial line, and `isBluetoothAllowed` if the page may use Bluetooth.
   */
  static async open(module, { adapterState = 'powered-on', hasRobot = true, isBluetoothAllowed = true } = {}) {
    const page = isBluetoothAllowed ? await openPage({}, prepareRadio) : await openForbidden('bluetooth', prepareRadio);
    const browserSession = await openDevTools();
    await browserSession.send('BluetoothEmulation.enable', { state: adapterState, leSupported: true });
    const radio = new Radio(page, browserSession, await page.context().newCDPSession(page), module);
    if (hasRobot) await page.evaluate(() => window.powerOnBoard());
    if (adapterState !== 'powered-on') return radio;
    const { name, service } = module;
    await browserSession.send('BluetoothEmulation.simulatePreconnectedPeripheral', { address: MODULE_ADDRESS, name, manufacturerData: [], knownServiceUuids: [service] });
    // A response may fail after the page was closed. If one fails earlier, the test times out.
    browserSession.on('BluetoothEmulation.gattOperationReceived', (event) => radio.respondToGatt(event).catch(() => {}));
    browserSession.on('BluetoothEmulation.characteristicOperationReceived', (event) => radio.respondToCharacteristic(event).catch(() => {}));
    await radio.pageSession.send('DeviceAccess.enable');
    return radio;
  }

  async respondToGatt({ type }) {
    if (type === 'discovery') await this.addService();
    if (type === 'connection' && this.isInRange) await this.connect();
    const code = this.isInRange ? 0 : OUT_OF_RANGE;
    await this.browserSession.send('BluetoothEmulation.simulateGATTOperationResponse', { address: MODULE_ADDRESS, type, code }).catch(() => {});
  }

  /** Connects the module, which then sends the robot a text without a line ending, as an HM-10 does. */
  async connect() {
    await this.page.evaluate(() => {
      window.isInRange = true;
      window.attachedBoard?.send([...'OK+CONN'].map((letter) => letter.charCodeAt(0)));
    });
  }

  async addService() {
    const { serviceId } = await this.browserSession.send('BluetoothEmulation.addService', { address: MODULE_ADDRESS, serviceUuid: this.module.service });
    for (const [characteristicUuid, propertyNames] of Object.entries(this.module.characteristics)) {
      const properties = Object.fromEntries(propertyNames.map((name) => [name, true]));
      const { characteristicId } = await this.browserSession.send('BluetoothEmulation.addCharacteristic', { serviceId, characteristicUuid, properties });
      if (properties.notify) await this.browserSession.send('BluetoothEmulation.addDescriptor', { characteristicId, descriptorUuid: CONFIGURATION_DESCRIPTOR });
    }
  }

  async respondToCharacteristic({ characteristicId, type, data, writeType }) {
    if (type === 'write') {
      const bytes = [...Buffer.from(data, 'base64')];
      await this.page.evaluate((bytes) => window.isInRange && window.attachedBoard?.send(bytes), bytes);
      this.packetLengths.push(bytes.length);
    }
    if (writeType === 'write-without-response') return;
    await this.browserSession.send('BluetoothEmulation.simulateCharacteristicOperationResponse', { characteristicId, type, code: 0 }).catch(() => {});
  }

  /** Advances the page's clock in steps; each step ends when the packets that the page wrote in it have arrived. */
  async run(ms) {
    for (let remainingMs = ms; remainingMs > 0; remainingMs -= STEP_MS) {
      await this.page.clock.runFor(STEP_MS);
      const haveArrived = async () => !this.isInRange || (await this.page.evaluate(() => window.writeCount)) <= this.packetLengths.length;
      await repeatUntil('packets to arrive', haveArrived, () => sleep(5));
    }
  }

  /** Advances the page's clock until `condition` returns true. */
  runUntil(awaitedEvent, condition) {
    return repeatUntil(awaitedEvent, condition, () => this.run(STEP_MS));
  }

  /** Presses the page's button for Bluetooth, and picks the module or cancels. */
  async pick(isModulePicked = true) {
    const prompt = new Promise((resolve) => this.pageSession.once('DeviceAccess.deviceRequestPrompted', resolve));
    await this.page.locator('#radio').click();
    const { id, devices } = await withTimeout('the browser to ask', prompt);
    if (isModulePicked) await this.pageSession.send('DeviceAccess.selectPrompt', { id, deviceId: devices[0].id });
    else await this.pageSession.send('DeviceAccess.cancelPrompt', { id });
  }

  /** Simulates a phone that sleeps: the page's timers stop, but the robot continues. */
  async simulatePhoneSleep(ms) {
    await this.page.evaluate((ms) => {
      for (let remainingMs = ms; remainingMs > 0; remainingMs -= 2) window.attachedBoard.run(16_000 * 2);
    }, ms);
  }

  async takeOutOfRange() {
    this.isInRange = false;
    await this.page.evaluate(() => {
      window.isInRange = false;
      window.attachedBoard.send([...'OK+LOST'].map((letter) => letter.charCodeAt(0)));
    });
    await this.browserSession.send('BluetoothEmulation.simulateGATTDisconnection', { address: MODULE_ADDRESS });
  }

  async bringIntoRange() {
    // Failed writes are never delivered.
    await this.page.evaluate((count) => (window.writeCount = count), this.packetLengths.length);
    this.isInRange = true;
  }

  async close() {
    await this.browserSession.send('BluetoothEmulation.disable');
  }
}
