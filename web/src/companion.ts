// A second robot on the same floor, which can walk another gait. It has its own instance of the firmware's core.
import { isRefused, type Frame, Robot } from './robot';
import type { ShownRobot } from './shown-robot';

/** Number of frames after which a robot that was switched on stands. */
const WAKE_FRAME_COUNT = 200;

export class Companion {
  /** The last frame; null before the first frame. */
  frame: Frame | null = null;
  /** The lines that the robot receives with the next frame. */
  private pendingLines = '';
  private readonly robot = new Robot();
  private readonly volts: number;

  /**
   * Creates a companion that stands at the start, with the floor, the servo model and the supply voltage of the
   * session. Throws an error with a message for the user.
   */
  constructor(toml: string, { floor, servos, volts }: ShownRobot) {
    this.volts = volts;
    const result = this.robot.load(toml);
    if (isRefused(result)) throw new Error(result.reason);
    this.robot.setFloor(floor);
    this.robot.setServoModel(servos);
    this.robot.startCore();
    for (let frame = 0; frame < WAKE_FRAME_COUNT; frame++) this.step();
    this.robot.returnToStart();
    this.step();
  }

  /** Frees the companion's memory; `frame` stays valid. */
  dispose(): void {
    this.robot.free();
  }

  /** Queues a line for the next frame. */
  send(line: string): void {
    this.pendingLines += `${line}\n`;
  }

  /** Advances by one frame of 20 ms. */
  step(): void {
    const widths = this.robot.runCoreFrame(this.pendingLines, this.volts);
    this.pendingLines = '';
    if (widths) this.frame = this.robot.followPulses(widths) ?? this.frame;
  }
}
