// The worker that checks other lengths, with its own instance of the robot in WebAssembly.
import { type Four, isRefused, Robot, type Scene } from '../robot';
import type { Answer, Question } from './question';

let robot: Promise<Robot>;

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | Question>) => {
  if (data instanceof WebAssembly.Module) robot = Robot.load(data);
  else void answer(data);
});

async function answer({ toml, edits, isLast, keys }: Question): Promise<void> {
  const page = await robot;
  const tried = page.lengths(toml, edits, isLast);
  const range = keys.length === 0 ? null : page.lengthRange(toml, keys);
  const reply: Answer = { ...tried, edits, scene: tried.refusal ? null : neutral(page, tried.text), isLast, range };
  postMessage(reply);
}

/** The neutral pose of a robot. */
function neutral(page: Robot, toml: string): Scene | null {
  const read = page.read(toml);
  if (isRefused(read)) return null;
  return page.pose(read.servos.map(({ neutral }) => neutral) as Four<number>, 1)?.scene ?? null;
}
