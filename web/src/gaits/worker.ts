// The worker that predicts an edited gait, with its own instance of the robot in WebAssembly.
import { Robot } from '../robot';
import type { Answer, Question } from './question';

let robot: Promise<Robot>;
/** The robot.toml that this worker read last. */
let known = '';

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | Question>) => {
  if (data instanceof WebAssembly.Module) robot = Robot.load(data);
  else void answer(data);
});

async function answer({ toml, floor, servos, made }: Question): Promise<void> {
  const page = await robot;
  if (toml !== known) page.read(toml);
  known = toml;
  page.setFloor(floor);
  page.setServos(servos);
  const reply: Answer = { made, trial: page.trial(made) };
  postMessage(reply);
}
