// The session: the robot that the page shows, and the board at the other end of the serial line, which is simulated
// unless a real board is connected. Views read the session, call its methods and follow its state: a view that reads
// the state in an `effect` runs again after each change.
import { Board, type BoardListener } from './board';
import { BoardProgram, type ProgramListener } from './board-program';
import { files } from './files';
import type { Link } from './link/link';
import { UnoLink } from './link/uno-link';
import { getMessage } from './problem';
import type { Four, Frame, Robot } from './robot';
import { SessionState } from './session-state';
import { FRAME_SECONDS, ShownRobot } from './shown-robot';
import { SimulatedBoard } from './uno/simulated-board';

/** Longest simulated time between two updates of `clock`, ms. */
const CLOCK_STEP_MS = 5;

/** Callbacks for a session's events; all other changes are in its state. */
export interface SessionListener extends ProgramListener, Omit<BoardListener, 'onPose'> {
  /**
   * Called for each frame of the simulated board with its pulse widths in CPU cycles, and for each pose report of a
   * real board with null. `seconds` is the duration of the frame, or of the frames since the previous report.
   */
  onFrame(frame: Frame, widths: Four<number> | null, seconds: number): void;
  /**
   * Called for each pulse: the Arduino number of its pin, the CPU cycle of its rising edge, and its width in CPU
   * cycles.
   */
  onPulse(pin: number, riseCycle: number, width: number): void;
}

export class Session {
  readonly state = new SessionState();
  readonly robot: ShownRobot;
  readonly board: Board;
  readonly program: BoardProgram;
  /** The robot's time, s: simulated time, or the total duration of a real board's reported frames. */
  clock = 0;
  /** The names of the inputs whose simulated contacts are closed. */
  readonly closedInputs = new Set<string>();
  private bootLoader: Uint8Array | null = null;
  /** The simulated UNO that has failed and no longer advances; null for none. */
  private failedLink: UnoLink | null = null;

  constructor(
    wasm: Robot,
    private readonly listener: SessionListener,
  ) {
    this.robot = new ShownRobot(wasm, this.state, async (eeprom) => {
      if (!this.board.isReal) await this.simulate(eeprom === 'own' ? this.simulatedLink?.board.eeprom : undefined);
    });
    this.board = new Board(this.state, this.robot, { ...listener, onPose: (angles, frameCount) => this.followPose(angles, frameCount) });
    this.program = new BoardProgram(this.state, this.robot, this.board, listener);
    this.state.volts.subscribe((volts) => this.simulatedLink?.board.setSupply(volts));
  }

  /** The link to the simulated board; null while a real board is connected. */
  private get simulatedLink(): UnoLink | null {
    const { link } = this.board;
    return link instanceof UnoLink ? link : null;
  }

  /** Powers on a new simulated UNO with the page's robot and, optionally, the previous UNO's EEPROM. */
  private async simulate(eeprom?: Uint8Array): Promise<void> {
    this.bootLoader ??= await files.bootLoader();
    await this.board.attach(() => {
      const { image, volts, description } = this.robot;
      const board = new SimulatedBoard(image, this.bootLoader, description.rail, eeprom);
      for (const [name, pin] of description.inputs) board.setContact(pin, this.closedInputs.has(name));
      board.setSupply(volts);
      const pins = description.servos.map(({ pin }) => pin);
      return new UnoLink(board, pins, (widths) => this.followPulses(widths), (...pulse) => this.listener.onPulse(...pulse));
    });
  }

  private followPulses(widths: Four<number>): void {
    const frame = this.robot.followPulses(widths);
    if (frame) this.listener.onFrame(frame, widths, FRAME_SECONDS);
  }

  private followPose(angles: Four<number>, frameCount: number): void {
    const seconds = FRAME_SECONDS * frameCount;
    this.clock += seconds;
    const frame = this.robot.followPose(angles, frameCount);
    if (frame) this.listener.onFrame(frame, null, seconds);
  }

  /**
   * Connects to a board that the user picked, and identifies it; returns true if the board is connected at the end, and
   * false if the user disconnects it or writes to it meanwhile. Throws an error with a message for the user.
   */
  async connect(link: Link | null): Promise<boolean> {
    if (!link) return false;
    link.onGone = (reason) => {
      void this.simulate().then(() => this.listener.onProblem('port', `The board is gone: ${reason} The simulation continues.`));
    };
    await this.board.attach(() => link);
    this.listener.onProblem('port', null);
    return this.program.identify();
  }

  /** Stops a board, disconnects it and returns to the simulation, unless an earlier call is doing this. */
  async disconnect(): Promise<void> {
    if (this.board.isLeaving) return;
    const hasStopped = await this.board.leave();
    await this.simulate();
    if (!hasStopped) {
      this.listener.onProblem('port', 'The disconnected board did not confirm its stop. If it is still walking, press its reset button.');
    }
  }

  /** Advances the simulation until it fails, which is reported; does nothing with a real board. */
  advance(ms: number): void {
    const { simulatedLink } = this;
    if (!simulatedLink || simulatedLink === this.failedLink) return;
    try {
      // The steps are short, so that each line of the robot gets its own time, even on a slow machine that catches up.
      for (let remainingMs = ms; remainingMs > 0; remainingMs -= CLOCK_STEP_MS) {
        const stepMs = Math.min(remainingMs, CLOCK_STEP_MS);
        this.clock += stepMs / 1000;
        simulatedLink.advance(stepMs);
      }
    } catch (error) {
      this.failedLink = simulatedLink;
      console.error(error);
      this.listener.onProblem('simulation', `The simulated UNO has stopped: ${getMessage(error)}`);
    }
  }

  /** Closes or opens the contact at an input in the simulation. */
  setContact(name: string, isClosed: boolean): void {
    if (isClosed) this.closedInputs.add(name);
    else this.closedInputs.delete(name);
    const input = this.robot.description.inputs.find(([inputName]) => inputName === name);
    if (input) this.simulatedLink?.board.setContact(input[1], isClosed);
  }
}
