// The page: a session, and the views that show it.
import { run } from './clock';
import { files, type RobotFile } from './files';
import { hasSerial } from './link/port-link';
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

/** Texts that follow the robot are written so many times a second. */
const TEXTS = 10;

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
  const robot = await Robot.load(await files.wasm());
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
  const drive = new Drive(robot, (command) => void session.ask(command), texts);
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
      const [slow, stop, rest] = description.supply;
      element('supply-note').textContent =
        `Below ${slow} V gaits go at half their pace, below ${stop} V the robot stops, below ${rest} V the pulses end.`;
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
    put('cycle', short(session.measured()) || '–');
    put('predicted', short(drive.way(gait)) || '–');
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

  const slider = (id: string, shown: (value: number) => string, use: (value: number) => void) => {
    const input = element<HTMLInputElement>(id);
    const show = () => (element(`${id}-out`).textContent = shown(input.valueAsNumber));
    input.addEventListener('input', show);
    input.addEventListener('change', () => use(input.valueAsNumber));
    show();
  };
  slider('speed', (value) => `${value} %`, (value) => void session.ask(`speed ${value}`));
  slider('friction', (value) => value.toFixed(2), (value) => {
    session.setFriction(value);
    drive.predict();
  });
  slider('supply', (value) => `${value.toFixed(2)} V`, (value) => session.setSupply(value));

  await choose();
  window.lizard = session;
  void calibrate;
  let sinceTexts = 0;
  run(
    (ms) => {
      sinceTexts += ms;
      session.advance(ms);
    },
    () => {
      floor.draw(session.last);
      scope.draw(latest);
      margins.draw(session.last?.scene ?? null);
      maps.draw();
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
