// The worker that predicts the path of a routine, with its own instance of the robot in WebAssembly.
import { isRefused, Robot } from '../robot';
import type { Answer, Question } from './question';

let robot: Promise<Robot>;

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | Question>) => {
  if (data instanceof WebAssembly.Module) robot = Robot.load(data);
  else void answer(data);
});

async function answer({ toml, floor, servos, routine }: Question): Promise<void> {
  const page = await robot;
  const isRight = !isRefused(page.read(toml));
  page.setFloor(floor);
  page.setServos(servos);
  const reply: Answer = isRight ? page.round(routine) : null;
  postMessage(reply);
}
