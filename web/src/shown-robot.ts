// The robot that the page shows: its robot.toml, the user's changes to it, its image, and its motion.
import { batch } from '@preact/signals-core';

import { type SavedChanges, browserStorage } from './browser-storage';
import { files } from './files';
import { isRefused } from './robot';
import type { Description, Floor, Four, Frame, Predictions, Refusal, Robot } from './robot';
import { FULL_PACE, type SessionState } from './session-state';
import { type CycleDisplacement, WalkedPath } from './walked-path';

/** Period of the firmware's frames, s. */
export const FRAME_SECONDS = 0.02;

export class ShownRobot {
  /** The name of the robot's file; empty while a file is being loaded. */
  file = '';
  toml = '';
  /** The unchanged text of the robot's file. */
  original = '';
  /** The robot and the user's changes to it, as this page last stored them; null before the first robot. */
  changes: SavedChanges | null = null;
  /** The robot's section of flash. */
  section: Uint8Array = new Uint8Array();
  /** The last frame; null before the first frame. */
  last: Frame | null = null;
  /** The page's predictions for the gaits in `original`; null if they are missing. */
  private predictions: Predictions | null = null;
  /** The firmware's image, the same for every robot. */
  private firmware: Uint8Array | null = null;
  /** Number of calls of `loadFile` so far; a file that arrives after a later call is dropped. */
  private loadCount = 0;
  private readonly walkedPath = new WalkedPath();

  /** `restart` restarts the simulated UNO, if there is one, with this robot and with an erased or its own EEPROM. */
  constructor(
    readonly wasm: Robot,
    private readonly state: SessionState,
    private readonly restart: (eeprom: 'erased' | 'own') => Promise<void>,
  ) {}

  get description(): Description {
    // The description is missing only before the first robot is loaded, when no view reads it.
    return this.state.description.value!;
  }

  /** Calls `show` with the current robot, if any, and with each later robot. */
  follow(show: (description: Description) => void): void {
    this.state.description.subscribe((description) => description && show(description));
  }

  /**
   * Loads a robot by its file name and restarts the simulated UNO with it; a real board stays connected. Returns false
   * if a later call has replaced this one. If the robot cannot be loaded, keeps the previous robot and throws an error
   * with a message for the user.
   */
  async loadFile(name: string): Promise<boolean> {
    const loadNumber = ++this.loadCount;
    this.file = '';
    try {
      const [toml, predictions, firmware] = await Promise.all([files.toml(name), files.predictions(name), this.firmware ?? files.firmware()]);
      if (loadNumber !== this.loadCount) return false;
      this.firmware = firmware;
      const refusal = this.loadToml(toml, null, [toml, predictions]);
      if (refusal) throw new Error(`${name}.toml: ${refusal.reason}`);
      await this.restart('erased');
      this.file = name;
      this.storeChanges();
      return loadNumber === this.loadCount;
    } catch (error) {
      if (loadNumber !== this.loadCount) return false;
      // Not the value before this call: an earlier call may already have emptied `file`.
      this.file = this.changes?.file ?? '';
      throw error;
    }
  }

  /**
   * Loads a changed robot.toml or returns its refusal. The simulated UNO restarts with it and keeps its EEPROM; a real
   * board keeps its own robot. The floor set in the page stays, unless `floor` replaces it.
   */
  async change(toml: string, floor = this.state.floor.value): Promise<Refusal | null> {
    const refusal = this.loadToml(toml, floor);
    if (refusal) return refusal;
    await this.restart('own');
    this.storeChanges();
    return null;
  }

  /**
   * Restores saved changes unless the robot's file has changed since; returns true if the changes were restored. If the
   * saved robot.toml is refused, servos and supply are restored all the same.
   */
  async restoreSaved({ original, toml, floor, servos, volts }: SavedChanges): Promise<boolean> {
    if (original !== this.original) return false;
    this.setServos(servos);
    this.setSupply(volts);
    return (await this.change(toml, floor)) === null;
  }

  private storeChanges(): void {
    const { file, original, toml, servos, volts } = this;
    if (file === '') return;
    this.changes = { file, original, toml, floor: this.state.floor.value, servos, volts };
    browserStorage.putChanges(this.changes);
  }

  private loadToml(toml: string, floorSetting: Floor | null, originalFile: [string, Predictions | null] = [this.original, this.predictions]): Refusal | null {
    const description = this.wasm.load(toml);
    if (isRefused(description)) return description;
    this.toml = toml;
    [this.original, this.predictions] = originalFile;
    this.section = this.wasm.section();
    this.wasm.setFloor(floorSetting ?? description.floor);
    this.walkedPath.clear();
    this.last = this.wasm.followPose(description.servos.map(({ neutral }) => neutral) as Four<number>, 1);
    batch(() => {
      this.state.floor.value = floorSetting;
      this.state.description.value = description;
    });
    return null;
  }

  /** The firmware and the robot as one image of the flash. */
  get image(): Uint8Array {
    const { firmware, section, description } = this;
    if (!firmware) throw new Error('the firmware is not loaded yet');
    const image = new Uint8Array(description.start + section.length).fill(0xff);
    image.set(firmware);
    image.set(section, description.start);
    return image;
  }

  /**
   * The page's stored predictions; null if the robot, its floor or its servos differ from the file, or if there are
   * none.
   */
  get filePredictions(): Predictions | null {
    return this.toml === this.original && this.state.floor.value === null && this.servos === 'own' ? this.predictions : null;
  }

  /** Floor, mass, feet and leg drive set in the page, else from robot.toml. */
  get floor(): Floor {
    return this.state.floor.value ?? this.description.floor;
  }

  /** Sets floor, mass, feet and leg drive; null restores the values of robot.toml. */
  setFloor(floor: Floor | null): void {
    this.state.floor.value = floor;
    this.wasm.setFloor(this.floor);
    this.storeChanges();
  }

  /** The name of the servo model: see `setServos`. */
  get servos(): string {
    return this.state.servos.value;
  }

  /** Sets the servo model: a name from the description, or such a name with a supply in V, as in `own at 4.2`. */
  setServos(name: string): void {
    this.state.servos.value = name;
    this.wasm.setServoModel(name);
    this.storeChanges();
  }

  /** The supply voltage of the simulated board. */
  get volts(): number {
    return this.state.volts.value;
  }

  /** Sets the supply voltage of the simulated board. */
  setSupply(volts: number): void {
    this.state.volts.value = volts;
    this.storeChanges();
  }

  /** Moves the robot for a frame with these pulse widths in CPU cycles; returns null if no robot is loaded. */
  followPulses(widths: Four<number>): Frame | null {
    return this.addFrame(this.wasm.followPulses(widths), FRAME_SECONDS);
  }

  /** Moves the robot to a pose, deg, in `frameCount` frames; returns null if no robot is loaded. */
  followPose(angles: Four<number>, frameCount: number): Frame | null {
    return this.addFrame(this.wasm.followPose(angles, frameCount), FRAME_SECONDS * frameCount);
  }

  private addFrame(frame: Frame | null, seconds: number): Frame | null {
    if (!frame) return null;
    this.last = frame;
    this.walkedPath.add(frame, seconds);
    return frame;
  }

  /** Starts a new cycle, because the robot's activity or its pace changes. */
  startCycle(): void {
    this.walkedPath.clear();
  }

  /** Returns the displacement in the last complete cycle; null if the gait does not move or no cycle is complete. */
  measureCycle(): CycleDisplacement | null {
    const { gait: activity, pace } = this.state;
    const gait = this.description.gaits.find(({ command }) => command === activity.value);
    return gait?.moves ? this.walkedPath.computeDisplacement((gait.period * FULL_PACE) / pace.value) : null;
  }

  /** Moves the robot back to its starting place on the floor. */
  returnToStart(): void {
    this.wasm.returnToStart();
    this.walkedPath.clear();
  }
}
