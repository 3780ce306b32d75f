// Writes the flash of a UNO through optiboot, its boot loader: STK500 version 1, as with avrdude's `-c arduino`.
import { load } from '../../../tools/judge/src/hex.js';
import { BOOT } from '../uno/board';
import { WORDS } from '../words';
import type { Link } from './link';

const OK = 0x10;
const IN_SYNC = 0x14;
const GET_SYNC = 0x30;
const LOAD_ADDRESS = 0x55;
const PROGRAM_PAGE = 0x64;
const READ_PAGE = 0x74;
const READ_SIGNATURE = 0x75;
const LEAVE = 0x51;
const END = 0x20;
const FLASH = 0x46;

const PAGE = 128;
/** A page of `rjmp .-2`, a jump to itself. */
const IDLE_PAGE = Uint8Array.from({ length: PAGE }, (_, n) => (n % 2 === 0 ? 0xff : 0xcf));
const SIGNATURE = [0x1e, 0x95, 0x0f];
const FLASH_SIZE = 32 * 1024;

/**
 * Time within which an answer must come, ms. Writing a page takes 20 ms, but a busy computer may deliver the bytes a
 * second late.
 */
const TIMEOUT = 2000;
/** Time after a reset in which the boot loader blinks and does not listen, ms. */
const BLINKING_TIME = 400;
/**
 * Attempts to reach the boot loader, and the time for each, ms: after blinking it listens for the rest of a second.
 */
const ATTEMPTS = 5;
const ATTEMPT_TIME = 110;
/** Time within which late answers to earlier attempts have arrived, ms. */
const LATE_TIME = 40;

export type Progress = (done: number, of: number, what: 'comparing' | 'writing' | 'verifying') => void;

/** Thrown if the data do not suit the board, its firmware or its link; nothing was written. */
export class FirmwareMismatch extends Error {}

/** Returns the flash image of a HEX file up to its last byte, in whole pages. Throws an error for the user. */
export function imageOf(hex: string): Uint8Array {
  const flash = new Uint8Array(FLASH_SIZE).fill(0xff);
  load(hex, flash);
  let end = flash.length;
  while (end > 0 && flash[end - 1] === 0xff) end -= 1;
  if (end === 0) throw new Error('the HEX file is empty');
  if (end > BOOT) throw new Error('the HEX file reaches into the boot loader, which cannot write itself');
  return flash.subarray(0, Math.ceil(end / PAGE) * PAGE);
}

/** A part of the console's list of words; every image of this firmware contains it. */
const CONSOLE = [WORDS.stop, WORDS.rest, WORDS.status, WORDS.pose].join('|');

/** Returns true if an image contains the console of this firmware. */
export function hasConsole(image: Uint8Array): boolean {
  return new TextDecoder('latin1').decode(image).includes(CONSOLE);
}

class Loader {
  private received: number[] = [];
  private arrived: () => void = () => {};

  constructor(private readonly link: Link) {
    link.onBytes = (bytes) => {
      this.received.push(...bytes);
      this.arrived();
    };
  }

  forget(): void {
    this.received = [];
  }

  /** Receives `count` bytes. Throws an error for the user. */
  async receive(count: number, timeout: number): Promise<number[]> {
    let late = false;
    void this.link.wait(timeout).then(() => {
      late = true;
      this.arrived();
    });
    while (this.received.length < count) {
      if (late) throw new Error('the board does not answer');
      await new Promise<void>((arrived) => (this.arrived = arrived));
    }
    return this.received.splice(0, count);
  }

  /** Sends a command and returns its answer of `answer` bytes. */
  async command(bytes: number[], answer = 0, timeout = TIMEOUT): Promise<number[]> {
    await this.link.write(Uint8Array.from([...bytes, END]));
    const got = await this.receive(answer + 2, timeout);
    if (got[0] !== IN_SYNC || got[got.length - 1] !== OK) throw new Error('the board answers out of step');
    return got.slice(1, -1);
  }
}

async function reachBootLoader(link: Link, loader: Loader): Promise<void> {
  await link.wait(BLINKING_TIME);
  for (let n = 1; ; n++) {
    loader.forget();
    try {
      await loader.command([GET_SYNC], 0, ATTEMPT_TIME);
      await link.wait(LATE_TIME);
      loader.forget();
      return;
    } catch (error) {
      if (n === ATTEMPTS) throw error;
    }
  }
}

/** Resets the board and reaches its boot loader. Throws an error for the user unless the chip is an ATmega328P. */
async function begin(link: Link): Promise<Loader> {
  const loader = new Loader(link);
  await link.reset();
  await reachBootLoader(link, loader);
  const signature = await loader.command([READ_SIGNATURE], 3);
  if (signature.some((byte, i) => byte !== SIGNATURE[i])) {
    const hex = signature.map((byte) => byte.toString(16).padStart(2, '0')).join(' ');
    throw new Error(`this is no ATmega328P, its signature is ${hex}`);
  }
  return loader;
}

/**
 * Resets the board, reads the chip's signature through its boot loader, and starts the program on the board. No other
 * code may use the link meanwhile. Throws an error for the user if the board is not a UNO.
 */
export async function identify(link: Link): Promise<void> {
  const loader = await begin(link);
  await loader.command([LEAVE]);
}

/** Bytes of flash and their address, which is the start of a page. */
export interface Piece {
  at: number;
  bytes: Uint8Array;
}

/** Returns the bytes in whole pages; the last page is filled up with 0xff, as in erased flash. */
function padToPages({ bytes }: Piece): Uint8Array {
  const pages = new Uint8Array(Math.ceil(bytes.length / PAGE) * PAGE).fill(0xff);
  pages.set(bytes);
  return pages;
}

/**
 * Resets the board, writes a piece of its flash, reads it back and starts the board. If `required` is given and the
 * board's flash differs from it, nothing is written. No other code may use the link meanwhile. Throws an error for
 * the user.
 */
export async function flash(link: Link, piece: Piece, progress: Progress, required: Piece | null = null): Promise<void> {
  const loader = await begin(link);
  const goTo = (address: number) => loader.command([LOAD_ADDRESS, (address >> 1) & 0xff, address >> 9]);
  /** Returns the address of the first byte of the flash that differs from `wanted`; -1 if none does. */
  const firstDifference = async (wanted: Piece, what: 'comparing' | 'verifying') => {
    const bytes = padToPages(wanted);
    for (let at = 0; at < bytes.length; at += PAGE) {
      await goTo(wanted.at + at);
      const read = await loader.command([READ_PAGE, 0, PAGE, FLASH], PAGE);
      // The bytes that fill up the last page do not count.
      const wrong = read.findIndex((byte, i) => at + i < wanted.bytes.length && byte !== bytes[at + i]);
      if (wrong >= 0) return wanted.at + at + wrong;
      progress(at + PAGE, bytes.length, what);
    }
    return -1;
  };
  if (required && (await firstDifference(required, 'comparing')) >= 0) {
    await loader.command([LEAVE]);
    throw new FirmwareMismatch('the firmware of the board is another one, in which this robot may not fit: write firmware and robot');
  }
  const image = padToPages(piece);
  const write = async (at: number, page: Uint8Array) => {
    await goTo(piece.at + at);
    await loader.command([PROGRAM_PAGE, 0, PAGE, FLASH, ...page]);
  };
  const verify = async (part: Piece) => {
    const wrong = await firstDifference(part, 'verifying');
    if (wrong >= 0) throw new Error(`the flash does not keep byte ${wrong}: try another board`);
  };
  // A half-written program might move the servos. So the page where the chip starts is an empty loop meanwhile, and
  // its real content is written last.
  const startsHere = piece.at === 0;
  progress(0, image.length, 'writing');
  if (startsHere) await write(0, IDLE_PAGE);
  for (let at = startsHere ? PAGE : 0; at < image.length; at += PAGE) {
    progress(at, image.length, 'writing');
    await write(at, image.subarray(at, at + PAGE));
  }
  if (startsHere) {
    await verify({ at: PAGE, bytes: piece.bytes.subarray(PAGE) });
    await write(0, image.subarray(0, PAGE));
    await verify({ at: 0, bytes: piece.bytes.subarray(0, PAGE) });
  } else await verify(piece);
  await loader.command([LEAVE]);
}
