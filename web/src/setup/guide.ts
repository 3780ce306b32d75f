// The calibration of a robot at its first connection. Signs come before trims, because a servo with a wrong sign
// would turn in the wrong direction. Nothing is stored before `save`; `restore` restores the old calibration.
import type { Answer } from '../link/dialogue';
import type { Link } from '../link/link';
import { type Calibration, type Four, isSameCalibration, readCalibration, reversedServo, scaledServo, Transfer } from '../robot';
import type { Session } from '../session';
import { parseStatus } from '../status';
import { GAITS, WORDS } from '../words';

/** Turns for proving a servo's sign, deg; tried in this order until the robot accepts one. */
const SIGN_TURNS = [10, 5, -10, -5];
/** Turns for measuring a servo's scale, deg; tried in this order until the robot accepts one. */
const SCALE_TURNS = [20, -20, 15, -15, 10, -10];
/** Longest wait for the end of a motion, ms, and time from one `status` to the next, ms. */
const MOTION_TIMEOUT_MS = 5000;
const POLL_INTERVAL_MS = 60;
/** Tolerance of a reached pose, deg. */
const TOLERANCE = 0.02;

/** Wraps an angle to at least 0 and less than 360 deg, rounded to hundredths as on the console. */
export function angle(degrees: number): number {
  return (((Math.round(degrees * 100) % 36_000) + 36_000) % 36_000) / 100;
}

/** Thrown with the robot's reason for a refusal. */
export class Refusal extends Error {}

/** Thrown if the board is gone, has restarted or does not answer. */
export class BoardChanged extends Error {}

export class Guide {
  /** The calibration at the beginning, or the one that was saved since. */
  private before: Calibration;
  /** The current calibration. */
  private now: Calibration;
  private readonly link: Link;
  private readonly banners: number;
  /** The robot's neutral angles, deg; null until it has stood. */
  private neutral: Four<number> | null = null;

  private constructor(
    private readonly session: Session,
    calibration: Calibration,
  ) {
    this.before = calibration;
    this.now = structuredClone(calibration);
    this.link = session.link;
    this.banners = session.banners;
  }

  /** Reads the robot's calibration; nothing moves. Throws an error for the user. */
  static async begin(session: Session): Promise<Guide> {
    const calibration = readCalibration((await sendLine(session, WORDS.cal)).notes);
    if (!calibration) throw new Error('The robot does not say its calibration as this page knows it: write this firmware first.');
    return new Guide(session, calibration);
  }

  /** True if the board is still the same and has not restarted. */
  get isCurrent(): boolean {
    return this.session.link === this.link && this.session.banners === this.banners;
  }

  /** The robot's calibration, saved or not. */
  get calibration(): Readonly<Calibration> {
    return this.now;
  }

  /** True if the current calibration is not saved. */
  get isChanged(): boolean {
    return !isSameCalibration(this.before, this.now);
  }

  /** Makes the robot stand; returns its neutral angles, deg. */
  async stand(): Promise<Four<number>> {
    await this.sendLine(GAITS.stand);
    return (this.neutral = await settle(this.session));
  }

  /** Ends the pulses, so that servos do not start all at once when they get power. */
  async rest(): Promise<void> {
    await this.sendLine(WORDS.rest);
  }

  /** Moves every servo to its middle, without its trim, for fitting the horns. */
  async center(): Promise<void> {
    await this.stand();
    await this.sendLine(WORDS.center);
    await settle(this.session);
  }

  /** Turns one servo from its neutral angle far enough to see its sign; returns the turn, deg counter-clockwise. */
  async prove(servo: number): Promise<number> {
    return this.turnServo(servo, SIGN_TURNS);
  }

  /**
   * Turns one servo from its neutral angle far enough to measure its scale; returns the turn, deg counter-clockwise.
   */
  async span(servo: number): Promise<number> {
    return this.turnServo(servo, SCALE_TURNS);
  }

  private async turnServo(servo: number, turns: number[]): Promise<number> {
    const neutral = await this.stand();
    let refusal: Refusal | null = null;
    for (const turn of turns) {
      try {
        await this.point(servo, neutral[servo] + turn);
        return turn;
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        refusal ??= error;
      }
    }
    throw refusal ?? new Refusal('there is no pose to turn it to');
  }

  /** Moves one servo to an angle, deg, and the others to neutral. */
  async point(servo: number, degrees: number): Promise<void> {
    const neutralAngles = this.neutral ?? (await this.stand());
    const pose = neutralAngles.map((neutral, index) => (index === servo ? degrees : neutral));
    await this.sendLine(`${WORDS.pose} ${pose.map((value) => angle(value).toFixed(2)).join(' ')}`);
    await settle(this.session, pose as Four<number>);
  }

  /** Reverses the sign of a servo. */
  async reverse(servo: number): Promise<void> {
    await this.stand();
    const newCalibration = structuredClone(this.now);
    const reversed = (newCalibration.servos[servo] = reversedServo(this.now.servos[servo]));
    await this.sendLine(`${WORDS.dir} ${servo + 1} ${reversed.dir}`);
    if (reversed.trim !== 0) await this.sendLine(`${WORDS.trim} ${servo + 1} ${reversed.trim.toFixed(2)}`);
    this.now = newCalibration;
    await settle(this.session);
  }

  /** Changes a servo's trim, deg counter-clockwise. */
  async trim(servo: number, change: number): Promise<void> {
    const newCalibration = structuredClone(this.now);
    const trim = Math.round((newCalibration.servos[servo].trim + change) * 100) / 100 + 0;
    newCalibration.servos[servo].trim = trim;
    await this.sendLine(`${WORDS.trim} ${servo + 1} ${trim.toFixed(2)}`);
    this.now = newCalibration;
  }

  /**
   * Sets a servo's scale from the turn that was measured, `measuredTurn`, for the commanded turn `askedTurn`, deg;
   * returns the scale, us per deg.
   */
  async scale(servo: number, askedTurn: number, measuredTurn: number): Promise<number> {
    await this.stand();
    const newCalibration = structuredClone(this.now);
    const oldSettings = this.now.servos[servo];
    const { scale, trim } = (newCalibration.servos[servo] = scaledServo(oldSettings, (oldSettings.scale * Math.abs(askedTurn)) / Math.abs(measuredTurn)));
    await this.sendLine(`${WORDS.scale} ${servo + 1} ${scale.toFixed(2)}`);
    try {
      // The horn stays where it is.
      if (trim !== oldSettings.trim) await this.sendLine(`${WORDS.trim} ${servo + 1} ${trim.toFixed(2)}`);
    } catch (error) {
      if (error instanceof Refusal) await this.sendLine(`${WORDS.scale} ${servo + 1} ${oldSettings.scale.toFixed(2)}`);
      throw error;
    }
    this.now = newCalibration;
    return scale;
  }

  /** Sets a servo's travel, counter-clockwise from the first angle to the second, deg. */
  async limit(servo: number, from: number, to: number): Promise<void> {
    const newCalibration = structuredClone(this.now);
    const limit: [number, number] = [angle(from), angle(to)];
    newCalibration.servos[servo].limit = limit;
    await this.sendLine(`${WORDS.limit} ${servo + 1} ${limit[0].toFixed(2)} ${limit[1].toFixed(2)}`);
    this.now = newCalibration;
  }

  /** Starts `walk`, or the first gait that moves; returns its command. */
  async walk(): Promise<string> {
    const { notes } = await this.sendLine(WORDS.help);
    const gaitList = notes.find((line) => line.startsWith('# gaits: '))?.slice('# gaits: '.length) ?? '';
    const gaits = gaitList.split('|').filter((name) => name !== '' && name !== GAITS.stand);
    const gait = gaits.includes(GAITS.walk) ? GAITS.walk : gaits[0];
    if (!gait) throw new Refusal('this robot has no gait');
    await this.sendLine(gait);
    return gait;
  }

  async save(): Promise<void> {
    await this.sendLine(WORDS.save);
    this.before = structuredClone(this.now);
  }

  /** Restores the old calibration and makes the robot stand; returns true if anything had changed. */
  async restore(): Promise<boolean> {
    try {
      await this.stand();
    } catch (error) {
      // A refusal, for example because of a low supply, must not prevent the restoring.
      if (!(error instanceof Refusal)) throw error;
    }
    if (!this.isChanged) return false;
    await this.apply(this.before);
    return true;
  }

  /**
   * Sets another calibration without saving it; if it is refused, the previous one is restored. Throws the robot's
   * reason.
   */
  async setCalibration(calibration: Calibration): Promise<void> {
    const previous = structuredClone(this.now);
    try {
      await this.apply(calibration);
      const readBack = readCalibration((await this.sendLine(WORDS.cal)).notes);
      if (!readBack || !isSameCalibration(readBack, calibration)) throw new Refusal('the robot did not accept all of it');
    } catch (error) {
      if (error instanceof Refusal) await this.apply(previous);
      throw error;
    }
    await settle(this.session);
  }

  /**
   * Sends the lines of a calibration; refused lines are sent again after the others. Throws a refusal if some are
   * still refused.
   */
  private async apply(calibration: Calibration): Promise<void> {
    const transfer = new Transfer(calibration);
    let refusal: Refusal | null = null;
    for (let line = transfer.nextLine(); line !== undefined; line = transfer.nextLine()) {
      try {
        await this.sendLine(line);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        if (transfer.refuse()) refusal = error;
      }
    }
    if (!transfer.isDone && refusal) throw refusal;
    this.now = structuredClone(calibration);
  }

  private sendLine(line: string): Promise<Answer> {
    if (!this.isCurrent) throw new BoardChanged('The board has restarted or is gone; what was not saved is lost.');
    return sendLine(this.session, line);
  }
}

/** Sends a line. Throws the reason of a refusal. */
async function sendLine(session: Session, line: string): Promise<Answer> {
  const { link } = session;
  const answer = await session.ask(line);
  if (!answer) throw new BoardChanged(session.link === link ? `The robot has not answered "${line}".` : 'The board is gone; what was not saved is lost.');
  if (!answer.ok) throw new Refusal(`The robot refuses "${line}": ${answer.text.replace(/^err \d+ /, '')}.`);
  return answer;
}

/**
 * Waits until the robot stands still, in the pose `expected` if given, but at most `MOTION_TIMEOUT_MS`; returns its
 * pose, deg.
 */
async function settle(session: Session, expected: Four<number> | null = null): Promise<Four<number>> {
  const isExpected = (pose: Four<number>) => expected?.every((degrees, n) => Math.abs(((degrees - pose[n] + 540) % 360) - 180) < TOLERANCE) ?? true;
  const { link } = session;
  let lastReport = null as { frames: number; pose: string } | null;
  for (let waitedMs = 0; ; waitedMs += POLL_INTERVAL_MS) {
    const answer = await session.ask(WORDS.status, true);
    const status = answer && parseStatus(answer.text);
    const pose = status?.pose;
    if (!status || !pose || session.link !== link) throw new BoardChanged('The board has restarted or is gone; what was not saved is lost.');
    const poseText = pose.join();
    if (lastReport?.pose !== poseText) lastReport = { frames: status.frames, pose: poseText };
    else if (status.frames - lastReport.frames >= session.description.still && isExpected(pose)) return pose;
    if (waitedMs >= MOTION_TIMEOUT_MS) return pose;
    await link.wait(POLL_INTERVAL_MS);
  }
}
