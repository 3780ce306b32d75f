// The worker that checks other lengths, with its own instance of the robot in WebAssembly.
import { type Four, isRefused, type Refused, Robot } from '../robot';
import type { Answer, Edits, Question } from './question';

/** Lengths are whole halves of a mm. */
const HALF = 0.5;

let robot: Promise<Robot>;

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | Question>) => {
  if (data instanceof WebAssembly.Module) robot = Robot.load(data);
  else void answer(data);
});

async function answer({ toml, edits, isLast }: Question): Promise<void> {
  const page = await robot;
  const [text, refused] = edited(page, toml, edits);
  const read = refused ? null : page.read(text);
  let said: Answer = { edits, toml: text, refused, scene: null, nearest: null, isLast };
  if (read && isRefused(read)) said = { ...said, refused: read };
  else if (read) {
    const neutral = read.servos.map(({ neutral }) => neutral) as Four<number>;
    said = { ...said, scene: page.pose(neutral, 1)?.scene ?? null };
  }
  if (said.refused && isLast) said = { ...said, nearest: nearest(page, toml, edits) };
  postMessage(said);
}

/** Returns the robot.toml with these lengths, and the refusal, if any. */
function edited(page: Robot, toml: string, edits: Edits): [string, Refused | null] {
  let text = toml;
  for (const [key, value] of edits) {
    const edited = page.edit(text, key, value);
    if (isRefused(edited)) return [text, edited];
    text = edited.text;
  }
  return [text, null];
}

/** Searches, by halving, the valid lengths nearest to refused ones on the straight line from the current ones. */
function nearest(page: Robot, toml: string, edits: Edits): Answer['nearest'] {
  const read = page.read(toml);
  if (isRefused(read)) return null;
  const now = new Map(read.lengths.map(({ key, value }) => [key, value]));
  const path = edits.map(([key, value]): [string, number, number] => [key, now.get(key) ?? value, value]);
  const steps = Math.ceil(Math.max(0, ...path.map(([, from, to]) => Math.abs(to - from))) / HALF);
  const at = (step: number): Edits => path.map(([key, from, to]) => [key, Math.round((from + ((to - from) * step) / steps) / HALF) * HALF]);
  let best: Answer['nearest'] = null;
  let [does, not] = [0, steps];
  while (not - does > 1) {
    const middle = Math.floor((does + not) / 2);
    const tried = at(middle);
    const [text, refused] = edited(page, toml, tried);
    if (refused || isRefused(page.read(text))) not = middle;
    else {
      does = middle;
      best = { edits: tried, toml: text };
    }
  }
  return best;
}
