// The page: a session, and the views that follow its state.
import { effect } from '@preact/signals-core';

import { Address, PAGE_ENTRY, addressParts } from './address';
import { runInRealTime } from './real-time';
import { files } from './files';
import { follow } from './follow';
import { browserStorage } from './browser-storage';
import { BluetoothLink, bluetoothProblem, IPHONE_ADVICE } from './link/bluetooth-link';
import type { Link } from './link/link';
import { hasSerial, NO_SERIAL_MESSAGE, PortLink } from './link/port-link';
import { installServiceWorker } from './offline';
import { Predictor } from './predictor';
import { canLag, load } from './robot';
import { Session } from './session';
import type { BoardBanner } from './session-state';
import { messageOf } from './problem';
import { Alarm } from './view/alarm';
import { BoardRobot } from './view/board-robot';
import { Calibrate } from './view/calibrate';
import { element, setText, showMessage } from './view/canvas';
import { RobotChoice } from './view/robot-choice';
import { downloadRobot } from './view/download';
import { Drive, formatDisplacement } from './view/drive';
import { FitView } from './view/fit';
import { FlashView } from './view/flash';
import { Floor } from './view/floor';
import { GaitsView } from './view/gaits';
import { Health } from './view/health';
import { RecordView } from './view/record';
import { Lengths } from './view/lengths';
import { Log } from './view/log';
import { MapView } from './view/maps';
import { MarginsView } from './view/margins';
import type { MeasureView } from './view/measure';
import { Pace } from './view/pace';
import { OwnRobot } from './view/own-robot';
import { PartsView } from './view/parts';
import { PathView } from './view/path';
import { Remote } from './view/remote';
import { RobotText } from './view/robot-text';
import { ROOM_OPENED, openRoom } from './view/rooms';
import { RoutinesView } from './view/routines';
import { ScopeView } from './view/scope';
import { Steering, gaitFor } from './view/steer';
import { Setup } from './view/setup';
import { Sketch } from './view/sketch';
import { ProblemList } from './view/problems';
import { World } from './view/world';
import { Writer } from './view/writer';
import { WORDS, unknownWords } from './words';

/** Rate at which the shown numbers are updated, 1/s. */
const NUMBER_UPDATES_PER_SECOND = 10;
/** Number of animation frames per drawing of scope, margins and maps, since painting costs the most time. */
const FRAMES_PER_DRAWING = 3;

declare global {
  interface Window {
    /** The page's session, for tests and for the browser's console. */
    lizard?: Session;
  }
}

const problems = new ProblemList();

async function start(): Promise<void> {
  const [module, choice] = await Promise.all([files.wasm(), RobotChoice.load()]);
  const session = new Session(load(module), {
    onFrame(frame, widths, seconds) {
      floor.addToTrack(frame.place);
      recordView.addFrame(frame, widths, seconds);
      if (frame.scene) for (const map of maps) map.addPose(frame.scene);
      if (widths) scope.setWidths(widths);
    },
    onPulse: (pin, rise, width) => {
      latestCycle = rise + width;
      scope.addPulse(pin, rise, width);
    },
    onSent(line) {
      log.showSent(line);
      measure?.noteSent(line);
    },
    onReceived(line) {
      log.showReceived(line);
      setup.noteReceived(line);
      measure?.noteReceived(line);
      if (line.startsWith('# fault')) remote.vibrate();
    },
    confirmUno: () =>
      confirm(
        'Is this board an Arduino UNO? By its USB chip it may also be a Nano, and this robot reaches into the boot section of a Nano. ' +
          'What is written there would ruin a Nano until a programmer at its pins repairs it. OK: it is a UNO.',
      ),
    onProblem(cause, message) {
      if (cause === 'fault' && message !== null) remote.vibrate();
      // A board without this firmware can get it at once.
      const remedy = { label: 'Write firmware and robot to it', action: () => flash.write('all') };
      problems.setMessage(cause, message, cause === 'board' && session.link.kind !== 'radio' ? remedy : null);
    },
  });

  let latestCycle = 0;
  const connectButton = element<HTMLButtonElement>('connect');
  const radioButton = element<HTMLButtonElement>('radio');
  const predictor = new Predictor(session);
  const scope = new ScopeView(session);
  const margins = new MarginsView(session);
  const maps = [new MapView(session, 0), new MapView(session, 1)];
  const log = new Log((line) => void session.ask(line));
  const floor = new Floor(() => {
    session.returnToStart();
    floor.clearTracks();
  });
  session.followRobot(() => floor.clearTracks());
  const isSetupOpen = () => setup.isOpen;
  const drive = new Drive(session, predictor);
  new Pace(session);
  const steer = new Steering(session, predictor, isSetupOpen);
  const writer = new Writer(session);
  new World(session);
  new Health(session, writer);
  new Lengths(session, (edits) => sketch.offerValidLengths(edits));
  const parts = new PartsView(session);
  const fit = new FitView(session, parts);
  const sketch = new Sketch(session, fit);
  const recordView = new RecordView(session, floor);
  new Calibrate(session);
  const alarm = new Alarm(session);
  const remote = new Remote();
  const text: RobotText = new RobotText(session, writer, () => routines.show());
  const routines = new RoutinesView(session, text, writer);
  new GaitsView(session, writer, (ownGait, foundGait, output) => {
    // The second robot is drawn from above alone.
    parts.set3d(false);
    return recordView.compare(ownGait, foundGait, output);
  });
  new PathView(session, writer);
  const flash = new FlashView(session, writer);
  const setup: Setup = new Setup(session, writer, () => connectBoard());
  const address = new Address(session, choice.chosenFile);
  // The view of the room Measure, loaded when the room is opened.
  let measure: MeasureView | null = null;
  const openMeasure = async () => {
    if (element('room-measure').hidden || measure || !session.description) return;
    const { MeasureView } = await import('./view/measure');
    measure ??= new MeasureView(session, predictor, isSetupOpen);
  };
  document.addEventListener(ROOM_OPENED, () => void openMeasure());
  session.followRobot(() => void openMeasure());
  new BoardRobot(session, problems, ({ file, toml }) => {
    choice.select(file);
    void replaceRobot(async () => {
      await loadChosenFile();
      if (session.toml !== toml) await session.change(toml);
    });
  });

  // When the page opens, the robot walks slowly until the user acts, unless the system is set to reduced motion.
  let isIntroOver = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const startIntroWalk = () => {
    const gait = gaitFor({ forward: 1, left: 0 }, predictor.gaits);
    if (isIntroOver || !gait || isSetupOpen() || session.isReal || session.gait !== session.description.gaits[0]?.command) return;
    isIntroOver = true;
    void session.drive(`${WORDS.speed} 50`).then(() => session.drive(gait));
  };
  // Any press of a pointer or a key ends the intro.
  for (const eventName of ['pointerdown', 'keydown']) document.addEventListener(eventName, () => (isIntroOver = true), { once: true });
  // On a slow machine the predictions may arrive before the robot's banner.
  follow([session.state.banner, predictor.predictions], () => session.banner && startIntroWalk());

  session.followRobot(({ words }) => {
    const missingWords = unknownWords([...drive.commands], words);
    if (missingWords.length > 0) problems.setMessage('page', `The core does not know these words of the page: ${missingWords.join(', ')}.`);
  });
  effect(() => {
    const { link, banner, description, isReal } = session;
    if (!link) return;
    const isBusy = writer.isBusy.value;
    setText(element('where'), boardText(link.name, banner, description.hash));
    // Reserves the height of the row for the text that most likely follows.
    const { version, name, hash } = description;
    element('where').parentElement!.dataset.room = boardText(link.name, { version, robot: { name, hash } }, hash);
    element('heard').hidden = !isReal;
    element<HTMLButtonElement>('reset').disabled = link.kind === 'radio';
    connectButton.textContent = isReal ? 'Back to the simulation' : 'Connect a board…';
    // While the boot loader uses the line, nothing else may take it.
    connectButton.disabled = isBusy || (!isReal && !hasSerial());
    radioButton.disabled = isBusy;
    radioButton.hidden = isReal || bluetoothProblem() !== null;
    choice.isEnabled = !isBusy;
  });
  session.state.link.subscribe(() => (latestCycle = 0));
  session.state.gait.subscribe(() => session.description && updateNumbers());
  function updateNumbers(): void {
    const { last, gait } = session;
    alarm.update();
    setText(element('doing'), gait || '–');
    setText(element('age'), `${session.secondsSinceLine.toFixed(1)} s ago`);
    if (last) {
      const { x, y, heading } = last.place;
      // Avoids -0.
      const round = (value: number, digits: number) => (Number(value.toFixed(digits)) + 0).toFixed(digits);
      setText(element('ahead'), `${round(y, 0)} mm`);
      setText(element('sideways'), `${round(x, 0)} mm`);
      setText(element('heading'), `${round(heading, 1)}°`);
    }
    const [measured, prediction] = [session.measured(), predictor.predictions.value.get(gait) ?? null];
    setText(element('cycle'), formatDisplacement(measured) || '–');
    setText(element('predicted'), formatDisplacement(prediction) || '–');
    // Rigid legs without play do not lag.
    const mayLag = canLag(session.floor);
    for (const box of document.querySelectorAll<HTMLElement>('.sprung')) box.hidden = !mayLag;
    setText(element('lag'), measured ? `${measured.lag.toFixed(1)}°` : '–');
    setText(element('share'), prediction?.share == null ? '–' : `${(100 * prediction.share).toFixed(0)} %`);
    showMessage(element('refusal'), last?.fault ?? last?.scene?.refusal ?? '');
  }

  const loadChosenFile = async () => {
    try {
      await session.loadFile(choice.chosenFile);
      problems.setMessage('robot', null);
    } catch (error) {
      choice.select(session.file);
      if (!session.link) element('where').textContent = 'No robot could be read.';
      problems.setMessage('robot', messageOf(error));
    }
  };
  const ownRobot = new OwnRobot(session, problems, (file) => (choice.select(file), loadChosenFile()), (names) => choice.showOwn(names));
  /** Loads another robot with `loadRobot`, and puts the user's changed robot aside, so that it is not lost. */
  const replaceRobot = async (loadRobot: () => Promise<unknown>) => {
    const saved = browserStorage.getChanges();
    await loadRobot();
    ownRobot.putAside(saved);
  };
  choice.onChange(() => void (choice.chosenOwnIndex === null ? replaceRobot(loadChosenFile) : ownRobot.restore(choice.chosenOwnIndex)));

  element('reset').addEventListener('click', () => void session.reset());

  if (!hasSerial()) {
    element('no-serial').textContent = IPHONE_ADVICE ?? NO_SERIAL_MESSAGE;
    element('no-serial').hidden = false;
  }
  async function connectBoard(open: () => Promise<Link | null> = () => PortLink.open()): Promise<void> {
    try {
      if (session.isReal) await session.disconnect();
      else if (await session.connect(await open())) setup.openNeededStep();
    } catch (error) {
      problems.setMessage('port', `No board is connected: ${messageOf(error)}`);
    }
  }
  connectButton.addEventListener('click', () => void connectBoard());
  radioButton.addEventListener('click', () => void connectBoard(() => BluetoothLink.open()));
  document.addEventListener('visibilitychange', () => document.hidden && session.stopIfWalking());
  // A board would walk on after its page is closed, so it is stopped, and the browser asks the user to confirm. It also
  // asks while an image is being written to a board.
  addEventListener('beforeunload', (event) => {
    if (session.isBoardWalking) void session.stop();
    else if (!(writer.isBusy.value && session.isReal)) return;
    event.preventDefault();
  });

  const saved = browserStorage.getChanges();
  const addressFile = addressParts(location.hash).get('file');
  const requestedFile = addressFile ?? saved?.file;
  const isKnownFile = requestedFile === undefined || choice.select(requestedFile);
  await loadChosenFile();
  const reportMissing = (file: string) => problems.setMessage('robot', `This page has no ${file}.toml, which its address asks for.`);
  if (addressFile !== null && !isKnownFile) reportMissing(addressFile);
  // The robot in the address takes precedence over a stored one.
  const isRobotInAddress = addressFile !== null || addressParts(location.hash).has('robot');
  if (saved && session.file === saved.file && !(await session.restoreSaved(saved)) && !isRobotInAddress) {
    const remedy = { label: 'Download what was changed', action: () => void downloadRobot(saved.toml, saved.floor) };
    const message = `${saved.file}.toml is not the file of last time, so what was changed of it then is not taken.`;
    problems.setMessage('robot', message, remedy);
  }
  if (await text.loadFromAddress()) address.start();
  if (isRobotInAddress) ownRobot.putAside(saved);
  addEventListener('popstate', ({ state }) => {
    const { hash } = location;
    openRoom(hash);
    // Within the page's own entries, Back and Forward change only the room, and the robot stays.
    if (state === PAGE_ENTRY) return address.scheduleUpdate();
    const file = addressParts(hash).get('file');
    if (file === null) return void replaceRobot(async () => (await text.loadFromAddress(hash)) && address.start());
    if (choice.select(file)) void replaceRobot(loadChosenFile);
    else reportMissing(file);
  });
  window.lizard = session;
  // The service worker starts only after everything that the page needs first is loaded.
  void installServiceWorker((loadNewer) => {
    element('fresh').hidden = false;
    element('fresh-take').onclick = loadNewer;
  });
  let msSinceNumbers = 0;
  let frameCount = 0;
  runInRealTime(
    (ms) => {
      msSinceNumbers += ms;
      session.advance(ms);
    },
    () => {
      steer.readGamepads();
      // Without a robot there is nothing to draw.
      if (!session.description) return;
      if (!parts.is3d || floor.paintsAlways) floor.draw(session.description.plate, recordView.frameToDraw(session.last), recordView.companionFrame);
      recordView.afterDrawing();
      parts.render(session.last);
      frameCount += 1;
      if (frameCount % FRAMES_PER_DRAWING === 0) {
        scope.draw(latestCycle);
        margins.draw(session.last?.scene ?? null);
        for (const map of maps) map.draw();
      }
      if (msSinceNumbers >= 1000 / NUMBER_UPDATES_PER_SECOND) {
        msSinceNumbers = 0;
        updateNumbers();
        recordView.updateNumbers();
        measure?.updateNumbers();
        scope.updateNumbers(session.last?.scene ?? null);
        margins.updateNumbers(session.last?.scene ?? null);
      }
    },
  );
}

/** Returns the text that names the board and its robot; `hash` is that of the page's robot. */
function boardText(name: string, banner: BoardBanner | undefined, hash: string): string {
  if (banner === undefined) return `waiting for the ${name}`;
  if (banner === null) return `on a ${name} without this firmware`;
  if (banner === 'unknown') return `on a ${name} that has not restarted: press its reset button to see which robot it has`;
  const { robot } = banner;
  if (!robot) return `on a ${name} with this firmware and no robot in it: write this one`;
  const robotText = `robot ${robot.name} ${robot.hash}`;
  return robot.hash === hash ? `on a ${name}, ${robotText}` : `on a ${name} with another robot, ${robotText}: choose that one, or write this one`;
}

openRoom(location.hash);
start().catch((error: unknown) => {
  element('where').textContent = 'The page cannot start.';
  problems.setMessage('page', messageOf(error));
});
