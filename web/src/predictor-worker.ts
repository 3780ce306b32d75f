// The worker of the Predictor, with its own instance of the robot in WebAssembly.
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

/** Predicts gait by gait; a newer question, handled in between, ends it. */
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
    const reply: Answer = { question, gait, prediction: known.predict(gait) };
    postMessage(reply);
  }
}
