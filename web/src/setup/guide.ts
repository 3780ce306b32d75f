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
const MOTION_TIMEOUT = 5000;
const POLL_INTERVAL = 60;
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

  private async turnServo(servo: number, choices: number[]): Promise<number> {
    const neutral = await this.stand();
    let refusal: Refusal | null = null;
    for (const by of choices) {
      try {
        await this.point(servo, neutral[servo] + by);
        return by;
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        refusal ??= error;
      }
    }
    throw refusal ?? new Refusal('there is no pose to turn it to');
  }

  /** Moves one servo to an angle, deg, and the others to neutral. */
  async point(servo: number, degrees: number): Promise<void> {
    const others = this.neutral ?? (await this.stand());
    const pose = others.map((neutral, place) => (place === servo ? degrees : neutral));
    await this.sendLine(`${WORDS.pose} ${pose.map((each) => angle(each).toFixed(2)).join(' ')}`);
    await settle(this.session, pose as Four<number>);
  }

  /** Reverses the sign of a servo. */
  async reverse(servo: number): Promise<void> {
    await this.stand();
    const next = structuredClone(this.now);
    const set = (next.servos[servo] = reversedServo(this.now.servos[servo]));
    await this.sendLine(`${WORDS.dir} ${servo + 1} ${set.dir}`);
    if (set.trim !== 0) await this.sendLine(`${WORDS.trim} ${servo + 1} ${set.trim.toFixed(2)}`);
    this.now = next;
    await settle(this.session);
  }

  /** Changes a servo's trim, deg counter-clockwise. */
  async trim(servo: number, by: number): Promise<void> {
    const next = structuredClone(this.now);
    const trim = Math.round((next.servos[servo].trim + by) * 100) / 100 + 0;
    next.servos[servo].trim = trim;
    await this.sendLine(`${WORDS.trim} ${servo + 1} ${trim.toFixed(2)}`);
    this.now = next;
  }

  /**
   * Sets a servo's scale from the turn that was `measured` for the commanded turn `asked`, deg; returns the scale, us
   * per deg.
   */
  async scale(servo: number, asked: number, measured: number): Promise<number> {
    await this.stand();
    const next = structuredClone(this.now);
    const old = this.now.servos[servo];
    const { scale, trim } = (next.servos[servo] = scaledServo(old, (old.scale * Math.abs(asked)) / Math.abs(measured)));
    await this.sendLine(`${WORDS.scale} ${servo + 1} ${scale.toFixed(2)}`);
    try {
      // The horn stays where it is.
      if (trim !== old.trim) await this.sendLine(`${WORDS.trim} ${servo + 1} ${trim.toFixed(2)}`);
    } catch (error) {
      if (error instanceof Refusal) await this.sendLine(`${WORDS.scale} ${servo + 1} ${old.scale.toFixed(2)}`);
      throw error;
    }
    this.now = next;
    return scale;
  }

  /** Sets a servo's travel, counter-clockwise from the first angle to the second, deg. */
  async limit(servo: number, from: number, to: number): Promise<void> {
    const next = structuredClone(this.now);
    const limit: [number, number] = [angle(from), angle(to)];
    next.servos[servo].limit = limit;
    await this.sendLine(`${WORDS.limit} ${servo + 1} ${limit[0].toFixed(2)} ${limit[1].toFixed(2)}`);
    this.now = next;
  }

  /** Starts `walk`, or the first gait that moves; returns its command. */
  async walk(): Promise<string> {
    const { notes } = await this.sendLine(WORDS.help);
    const list = notes.find((line) => line.startsWith('# gaits: '))?.slice('# gaits: '.length) ?? '';
    const gaits = list.split('|').filter((name) => name !== '' && name !== GAITS.stand);
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
  async setCalibration(set: Calibration): Promise<void> {
    const had = structuredClone(this.now);
    try {
      await this.apply(set);
      const read = readCalibration((await this.sendLine(WORDS.cal)).notes);
      if (!read || !isSameCalibration(read, set)) throw new Refusal('the robot did not accept all of it');
    } catch (error) {
      if (error instanceof Refusal) await this.apply(had);
      throw error;
    }
    await settle(this.session);
  }

  /**
   * Sends the lines of a calibration; refused lines are sent again after the others. Throws a refusal if some are
   * still refused.
   */
  private async apply(set: Calibration): Promise<void> {
    const transfer = new Transfer(set);
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
    this.now = structuredClone(set);
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
 * Waits until the robot stands still, in the pose `wanted` if given, but at most `MOTION_TIMEOUT`; returns its pose,
 * deg.
 */
async function settle(session: Session, wanted: Four<number> | null = null): Promise<Four<number>> {
  const isThere = (pose: Four<number>) => wanted?.every((each, n) => Math.abs(((each - pose[n] + 540) % 360) - 180) < TOLERANCE) ?? true;
  const { link } = session;
  let last = null as { frames: number; pose: string } | null;
  for (let waited = 0; ; waited += POLL_INTERVAL) {
    const answer = await session.ask(WORDS.status, true);
    const now = answer && parseStatus(answer.text);
    const here = now?.pose;
    if (!now || !here || session.link !== link) throw new BoardChanged('The board has restarted or is gone; what was not saved is lost.');
    const pose = here.join();
    if (last?.pose !== pose) last = { frames: now.frames, pose };
    else if (now.frames - last.frames >= session.description.still && isThere(here)) return here;
    if (waited >= MOTION_TIMEOUT) return here;
    await link.wait(POLL_INTERVAL);
  }
}
