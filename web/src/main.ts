// The page: a session, and the views that show it.
import { run } from './clock';
import { files, type RobotFile } from './files';
import { hasSerial } from './link/port-link';
import { Predictor } from './predictor';
import { Robot } from './robot';
import { Session } from './session';
import { Calibrate } from './view/calibrate';
import { element } from './view/canvas';
import { Drive, short } from './view/drive';
import { FlashView } from './view/flash';
import { Floor } from './view/floor';
import { Health } from './view/health';
import { Lengths } from './view/lengths';
import { Log } from './view/log';
import { MapsView } from './view/maps';
import { MarginsView } from './view/margins';
import { ScopeView } from './view/scope';
import { World } from './view/world';

/** Texts that follow the robot are written so many times a second. */
const TEXTS = 10;
/** Scope, margins and maps are drawn in each third picture: painting is what costs. */
const PANELS = 3;

declare global {
  interface Window {
    /** For tests and the curious. */
    lizard?: Session;
  }
}

function trouble(sentence: string | null): void {
  const box = element('trouble');
  if (box.textContent === (sentence ?? '')) return;
  box.hidden = sentence === null;
  box.textContent = sentence ?? '';
}

async function start(): Promise<void> {
  const module = await files.wasm();
  const robot = await Robot.load(module);
  const choices: RobotFile[] = await files.robots();
  const now = () => session;

  const scope = new ScopeView();
  const margins = new MarginsView();
  const maps = new MapsView();
  const log = new Log((line) => void session.ask(line));
  const floor = new Floor(() => {
    session.home();
    floor.clear();
  });
  const drive = new Drive((command) => void session.ask(command));
  const predictor = new Predictor(module, (gait, outlook) => {
    drive.predicted(gait, outlook);
    texts();
  });
  const predict = () => {
    const { toml, floor, servos, description } = session;
    const first = description.gaits.findIndex(({ command }) => command === session.gait);
    predictor.ask({ toml, floor, servos, gaits: description.gaits.length, first: Math.max(0, first) });
  };
  const world = new World(now, predict);
  const health = new Health(now);
  const lengths = new Lengths(now);
  const calibrate = new Calibrate(now);
  const flash = new FlashView(now, (busy) => (health.held = busy));

  const session: Session = new Session(robot, {
    robot(description) {
      scope.robot(description);
      margins.robot(description);
      maps.robot(robot);
      drive.take(description);
      lengths.take(description.lengths);
      floor.clear();
      world.take();
      predict();
    },
    frame(frame, widths) {
      floor.walked(frame.place);
      if (frame.scene) maps.at(frame.scene);
      if (widths) scope.frame(widths);
    },
    pulse: (pin, rise, width) => {
      latest = rise + width;
      scope.pulse(pin, rise, width);
    },
    sent: (line) => log.sent(line),
    came: (line) => log.came(line),
    doing(gait) {
      drive.doing(gait);
      texts();
    },
    tables(hash) {
      const { link, description } = session;
      element('where').textContent = !link.canFlash
        ? `${link.name}: no image has these lengths, tables ${hash}`
        : hash === description.hash
          ? `on a ${link.name}, tables ${hash}`
          : `on a ${link.name} with the image of another robot, tables ${hash}: choose that robot, or flash this one's`;
    },
    link(link) {
      latest = 0;
      element('where').textContent = `waiting for the ${link.name}`;
      element('connect').textContent = session.isReal ? 'Back to the simulation' : 'Connect a board…';
      flash.update();
    },
    trouble,
  });
  let latest = 0;

  function texts(): void {
    const { last, gait } = session;
    const put = (id: string, text: string) => {
      const box = element(id);
      if (box.textContent !== text) box.textContent = text;
    };
    put('doing', gait || '–');
    if (last) {
      const { x, y, heading } = last.place;
      // Without the sign of a zero.
      const round = (value: number, digits: number) => (Number(value.toFixed(digits)) + 0).toFixed(digits);
      put('ahead', `${round(y, 0)} mm`);
      put('sideways', `${round(x, 0)} mm`);
      put('heading', `${round(heading, 1)}°`);
    }
    const [measured, outlook] = [session.measured(), drive.outlook(gait)];
    put('cycle', short(measured) || '–');
    put('predicted', short(outlook) || '–');
    // Rigid legs do not lag.
    const sprung = session.floor.stiffness !== null;
    for (const box of document.querySelectorAll<HTMLElement>('.sprung')) box.hidden = !sprung;
    put('lag', measured ? `${measured.lag.toFixed(1)}°` : '–');
    put('share', outlook?.share == null ? '–' : `${(100 * outlook.share).toFixed(0)} %`);
    const refusal = last?.fault ?? last?.scene?.refusal ?? null;
    element('refusal').hidden = refusal === null;
    put('refusal', refusal ?? '');
  }

  const select = element<HTMLSelectElement>('robot');
  for (const { name, image } of choices) {
    select.add(new Option(`${name}.toml${image ? '' : ' (no image)'}`, name));
  }
  const choose = async () => {
    const choice = choices.find(({ name }) => name === select.value) ?? choices[0];
    try {
      await session.choose(choice.name, choice.image);
      trouble(null);
    } catch (error) {
      trouble(error instanceof Error ? error.message : String(error));
    }
  };
  select.addEventListener('change', () => void choose());

  element('reset').addEventListener('click', () => void session.reset());

  const connect = element<HTMLButtonElement>('connect');
  if (!hasSerial()) {
    connect.disabled = true;
    connect.title = 'This browser has no Web Serial; Chromium, Chrome and Edge have it.';
  }
  connect.addEventListener('click', () => {
    const change = session.isReal ? session.simulate() : session.connect();
    change.catch((error: unknown) => trouble(error instanceof Error ? error.message : String(error)));
  });

  const speed = element<HTMLInputElement>('speed');
  const showSpeed = () => (element('speed-out').textContent = `${speed.value} %`);
  speed.addEventListener('input', showSpeed);
  speed.addEventListener('change', () => void session.ask(`speed ${speed.value}`));
  showSpeed();

  await choose();
  window.lizard = session;
  void calibrate;
  let sinceTexts = 0;
  let pictures = 0;
  run(
    (ms) => {
      sinceTexts += ms;
      session.advance(ms);
    },
    () => {
      floor.draw(session.description.plate, session.last);
      pictures += 1;
      if (pictures % PANELS === 0) {
        scope.draw(latest);
        margins.draw(session.last?.scene ?? null);
        maps.draw();
      }
      if (sinceTexts >= 1000 / TEXTS) {
        sinceTexts = 0;
        texts();
        scope.write(session.last?.scene ?? null);
        margins.write(session.last?.scene ?? null);
      }
    },
  );
}

start().catch((error: unknown) => trouble(error instanceof Error ? error.message : String(error)));
