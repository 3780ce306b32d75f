// The other end of the Predictor: the robot in WebAssembly once more, in a thread of its own.
import type { Answer, Question } from './predictor';
import { Robot } from './robot';

let robot: Promise<Robot>;
let asked = 0;

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | (Question & { question: number })>) => {
  if (data instanceof WebAssembly.Module) robot = Robot.load(data);
  else {
    asked = data.question;
    void answer(data);
  }
});

/** Gait by gait, and in between what has been asked since is heard. */
async function answer({ question, toml, floor, servos, gaits, first }: Question & { question: number }): Promise<void> {
  const known = await robot;
  if (question !== asked) return;
  known.read(toml);
  known.setFloor(floor);
  known.setServos(servos);
  for (let n = 0; n < gaits; n++) {
    const gait = (first + n) % gaits;
    await new Promise((turn) => setTimeout(turn));
    if (question !== asked) return;
    const said: Answer = { question, gait, outlook: known.predict(gait) };
    postMessage(said);
  }
}
