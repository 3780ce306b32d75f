// A second robot on the same floor, which can walk another gait. It has its own instance of the firmware's core.
import { isRefused, type Floor, type Frame, Robot } from './robot';

/** Number of frames between power-on and standing. */
const WAKE_FRAME_COUNT = 200;

export class Companion {
  /** The last frame; null before the first frame. */
  frame: Frame | null = null;
  /** The lines that the robot receives with the next frame. */
  private pendingLines = '';

  private constructor(
    private readonly robot: Robot,
    private readonly volts: number,
  ) {}

  /**
   * Creates a companion that stands at the start, with this floor and this servo model. Throws an error with a message
   * for the user.
   */
  static create(toml: string, floor: Floor, servoModel: string, volts: number): Companion {
    const robot = new Robot();
    const result = robot.read(toml);
    if (isRefused(result)) throw new Error(result.refused);
    robot.setFloor(floor);
    robot.setServos(servoModel);
    robot.startCore();
    const companion = new Companion(robot, volts);
    for (let frame = 0; frame < WAKE_FRAME_COUNT; frame++) companion.step();
    robot.restart();
    companion.step();
    return companion;
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
    const output = this.robot.runCoreFrame(this.pendingLines, this.volts);
    this.pendingLines = '';
    if (output) this.frame = this.robot.followPulses(output.widths) ?? this.frame;
  }
}
