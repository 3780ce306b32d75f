// The page: a session, and the views that follow its state.
import { effect } from '@preact/signals-core';

import { Address, PAGE_ENTRY_STATE, parseFragment } from './address';
import { runInRealTime } from './real-time';
import { files } from './files';
import { follow } from './follow';
import { browserStorage } from './browser-storage';
import { BluetoothLink, findBluetoothProblem, IPHONE_ADVICE } from './link/bluetooth-link';
import type { Link } from './link/link';
import { hasSerial, NO_SERIAL_MESSAGE, PortLink } from './link/port-link';
import { installServiceWorker } from './offline';
import { Predictor } from './predictor';
import { canLag, loadModule } from './robot';
import { workerFailure } from './robot-requests';
import { Session } from './session';
import type { BoardBanner } from './session-state';
import { getMessage } from './problem';
import { setUpAlarm } from './view/alarm';
import { warnOfBoardRobot } from './view/board-robot-warning';
import { setUpCalibration } from './view/calibrate';
import { element, setText, showMessage } from './view/elements';
import { RobotChoice } from './view/robot-choice';
import { downloadRobot } from './view/download';
import { DriveView, formatDisplacement } from './view/drive';
import { FitView } from './view/fit';
import { FlashView } from './view/flash';
import { FloorView } from './view/floor';
import { GaitEditorView } from './view/gait-editor';
import { setUpHealth } from './view/health';
import { RecordView } from './view/record';
import { setUpLengths } from './view/lengths';
import { LogView } from './view/log';
import { SingularityMapView } from './view/singularity-map';
import { MarginsView } from './view/margins';
import type { MeasureView } from './view/measure';
import { setUpPace } from './view/pace';
import { OwnRobots } from './view/own-robots';
import { PartsView } from './view/parts';
import { GestureEditorView } from './view/gesture-editor';
import { setUpRemote, vibrate } from './view/remote';
import { RobotTextView } from './view/robot-text';
import { ROOM_OPENED, openRoom } from './view/rooms';
import { RoutinesView } from './view/routines';
import { ScopeView } from './view/scope';
import { chooseGait, Steering } from './view/steer';
import { SetupDialog } from './view/setup';
import { SketchView } from './view/sketch';
import { ProblemList } from './view/problems';
import { setUpWorld } from './view/world';
import { BoardWriter } from './view/writer';
import { WORDS, findUnknownWords } from './words';

/** Update rate of the shown numbers, 1/s. */
const NUMBER_UPDATES_PER_SECOND = 10;
/** Number of animation frames per drawing of scope, margins and maps, because drawing takes the most time. */
const FRAMES_PER_DRAWING = 3;

declare global {
  interface Window {
    /** The page's session, for tests and the browser's console. */
    lizard?: Session;
  }
}

const problems = new ProblemList();
workerFailure.subscribe((message) => problems.setMessage('page', message));

async function start(): Promise<void> {
  const [module, choice] = await Promise.all([files.robotModule(), files.robots().then((robots) => new RobotChoice(robots))]);
  const session = new Session(loadModule(module), {
    onFrame(frame, widths, seconds) {
      floor.addToTrack(frame.place);
      recordView.addFrame(frame, widths, seconds);
      if (frame.scene) for (const map of maps) map.addPose(frame.scene);
      if (widths) scope.frameWidths = widths;
    },
    onPulse: (pin, riseCycle, width) => scope.addPulse(pin, riseCycle, width),
    onSent(line) {
      log.showSent(line);
      setup.handleSent(line);
      measure?.protocol?.handleSent(line);
    },
    onReceived(line) {
      log.showReceived(line);
      setup.handleReceived(line);
      measure?.protocol?.handleReceived(line);
      if (line.startsWith('# fault')) vibrate();
    },
    confirmUno: () =>
      confirm(
        'Is this board an Arduino UNO? Its USB chip is also used on the Nano, and this robot reaches into the boot section of a Nano. ' +
          'Writing there would overwrite a Nano’s boot loader, which only a programmer at its pins can repair. OK: it is a UNO.',
      ),
    onProblem(cause, message) {
      if (cause === 'fault' && message !== null) vibrate();
      // The page offers to write this firmware to a board without it.
      const remedy = { label: 'Write firmware and robot to it', action: () => flash.write('all') };
      problems.setMessage(cause, message, cause === 'board' && session.board.link.kind !== 'radio' ? remedy : null);
    },
  });

  const connectButton = element<HTMLButtonElement>('connect');
  const radioButton = element<HTMLButtonElement>('radio');
  const predictor = new Predictor(session);
  const scope = new ScopeView(session);
  const margins = new MarginsView(session);
  const maps = [new SingularityMapView(session, 0), new SingularityMapView(session, 1)];
  const log = new LogView((line) => void session.board.ask(line));
  const floor = new FloorView(() => {
    session.robot.returnToStart();
    floor.clearTracks();
  });
  session.robot.follow(() => floor.clearTracks());
  const isSetupOpen = () => setup.isOpen;
  const drive = new DriveView(session, predictor);
  setUpPace(session);
  const steer = new Steering(session, predictor, isSetupOpen);
  const writer = new BoardWriter(session);
  setUpWorld(session);
  setUpHealth(session, writer);
  setUpLengths(session, (edits) => sketch.offerValidLengths(edits));
  const parts = new PartsView(session);
  const fit = new FitView(session, parts);
  const sketch = new SketchView(session, fit);
  const recordView = new RecordView(session, floor);
  setUpCalibration(session);
  const updateAlarm = setUpAlarm(session);
  setUpRemote(() => void session.board.drive(WORDS.stop));
  const robotText: RobotTextView = new RobotTextView(session, writer, () => routines.show());
  const routines = new RoutinesView(session, robotText, writer);
  new GaitEditorView(session, writer, (referenceGait, foundGait, output) => {
    // The second robot is drawn only from above.
    parts.set3d(false);
    return recordView.compare(referenceGait, foundGait, output);
  });
  new GestureEditorView(session, writer);
  const flash = new FlashView(session, writer);
  const setup: SetupDialog = new SetupDialog(session, writer, () => toggleBoard());
  const address = new Address(session, choice.chosenFile);
  // The view of the room Measure is loaded when the room is opened.
  let measure: MeasureView | null = null;
  const openMeasure = async () => {
    if (element('room-measure').hidden || measure || !session.robot.description) return;
    try {
      const { MeasureView } = await import('./view/measure');
      measure ??= new MeasureView(session, predictor, isSetupOpen);
    } catch (error) {
      problems.setMessage('page', `The room Measure cannot be opened (${getMessage(error)}). Reload the page to try again.`);
    }
  };
  document.addEventListener(ROOM_OPENED, () => void openMeasure());
  session.robot.follow(() => void openMeasure());
  warnOfBoardRobot(session, problems, ({ file, toml }) => {
    choice.select(file);
    void replaceRobot(async () => {
      await loadChosenFile();
      if (session.robot.toml !== toml) await session.robot.change(toml);
    });
  });

  // When the page opens, the robot walks slowly until the user acts, unless the system is set to reduced motion.
  let isIntroOver = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const startIntroWalk = () => {
    const gait = chooseGait({ forward: 1, left: 0 }, predictor.gaits);
    if (isIntroOver || !gait || isSetupOpen() || session.board.isReal || session.board.gait !== session.robot.description.gaits[0]?.command) return;
    isIntroOver = true;
    void session.board.drive(`${WORDS.speed} 50`).then(() => session.board.drive(gait));
  };
  // Pressing a pointer or a key ends the intro.
  for (const eventName of ['pointerdown', 'keydown']) document.addEventListener(eventName, () => (isIntroOver = true), { once: true });
  // On a slow machine, the predictions may arrive before the robot's banner.
  follow([session.state.banner, predictor.predictions], () => session.board.banner && startIntroWalk());

  session.robot.follow(({ words }) => {
    const missingWords = findUnknownWords([...drive.commands], words);
    if (missingWords.length > 0) problems.setMessage('page', `The page sends words that the core does not have: ${missingWords.join(', ')}.`);
  });
  effect(() => {
    const { link, banner, isReal } = session.board;
    if (!link) return;
    const { description } = session.robot;
    const isBusy = writer.isBusy.value;
    setText(element('where'), describeBoard(link.name, banner, description.hash));
    // Reserves the row's height for the text that most likely follows.
    const { version, name, hash } = description;
    element('where').parentElement!.dataset.longestText = describeBoard(link.name, { version, robot: { name, hash } }, hash);
    element('heard').hidden = !isReal;
    element<HTMLButtonElement>('reset').disabled = isBusy || link.kind === 'radio';
    connectButton.textContent = isReal ? 'Back to the simulation' : 'Connect a board…';
    // While the boot loader uses the line, no other action may use it.
    connectButton.disabled = isBusy || (!isReal && !hasSerial());
    radioButton.disabled = isBusy;
    radioButton.hidden = isReal || findBluetoothProblem() !== null;
    choice.list.disabled = isBusy;
  });
  session.state.gait.subscribe(() => session.robot.description && updateNumbers());
  function updateNumbers(): void {
    const { last } = session.robot;
    const { gait } = session.board;
    updateAlarm();
    setText(element('doing'), gait || '–');
    setText(element('age'), `${session.board.secondsSinceLine.toFixed(1)} s ago`);
    if (last) {
      const { x, y, heading } = last.place;
      // Avoids -0.
      const round = (value: number, digits: number) => (Number(value.toFixed(digits)) + 0).toFixed(digits);
      setText(element('ahead'), `${round(y, 0)} mm`);
      setText(element('sideways'), `${round(x, 0)} mm`);
      setText(element('heading'), `${round(heading, 1)}°`);
    }
    const [measured, prediction] = [session.robot.measureCycle(), predictor.predictions.value.get(gait) ?? null];
    setText(element('cycle'), formatDisplacement(measured) || '–');
    setText(element('predicted'), formatDisplacement(prediction) || '–');
    // Rigid legs without play do not lag.
    const mayLag = canLag(session.robot.floor);
    for (const box of document.querySelectorAll<HTMLElement>('.sprung')) box.hidden = !mayLag;
    setText(element('lag'), measured ? `${measured.lag.toFixed(1)}°` : '–');
    setText(element('share'), prediction?.fraction == null ? '–' : `${(100 * prediction.fraction).toFixed(0)} %`);
    showMessage(element('refusal'), last?.loop_error ?? last?.scene?.refusal ?? '');
  }

  /** Loads the chosen file, or reports why it cannot be loaded; returns false if another robot was chosen meanwhile. */
  const loadChosenFile = async () => {
    try {
      const isLatest = await session.robot.loadFile(choice.chosenFile);
      if (isLatest) problems.setMessage('robot', null);
      return isLatest;
    } catch (error) {
      choice.select(session.robot.file);
      if (!session.board.link) element('where').textContent = 'No robot is loaded.';
      problems.setMessage('robot', getMessage(error));
      return true;
    }
  };
  const ownRobots = new OwnRobots(session, problems, (file) => (choice.select(file), loadChosenFile()), (names) => choice.showOwn(names));
  /** Loads another robot with `loadRobot`, and puts the user's changed robot aside. */
  const replaceRobot = async (loadRobot: () => Promise<unknown>) => {
    const { changes } = session.robot;
    await loadRobot();
    ownRobots.putAside(changes);
  };
  choice.list.addEventListener('change', () => void (choice.chosenOwnIndex === null ? replaceRobot(loadChosenFile) : ownRobots.restore(choice.chosenOwnIndex)));

  element('reset').addEventListener('click', () => void session.board.reset());

  if (!hasSerial()) showMessage(element('no-serial'), IPHONE_ADVICE ?? NO_SERIAL_MESSAGE);
  async function toggleBoard(open: () => Promise<Link | null> = () => PortLink.open()): Promise<void> {
    try {
      if (session.board.isReal) await session.disconnect();
      else if (await session.connect(await open())) setup.openNeededStep();
    } catch (error) {
      problems.setMessage('port', `No board is connected: ${getMessage(error)}`);
    }
  }
  connectButton.addEventListener('click', () => void toggleBoard());
  radioButton.addEventListener('click', () => void toggleBoard(() => BluetoothLink.open()));
  document.addEventListener('visibilitychange', () => document.hidden && session.board.stopIfWalking());
  // Closing the page would leave a walking board: the page stops the board, and the browser asks the user to confirm.
  // The browser also asks while an image is being written to a board.
  addEventListener('beforeunload', (event) => {
    if (session.board.isWalking) void session.board.stop();
    else if (!(writer.isBusy.value && session.board.isReal)) return;
    event.preventDefault();
  });

  const saved = browserStorage.getChanges();
  const addressFile = parseFragment(location.hash).get('file');
  const requestedFile = addressFile ?? saved?.file;
  const isKnownFile = requestedFile === undefined || choice.select(requestedFile);
  await loadChosenFile();
  const reportMissing = (file: string) => problems.setMessage('robot', `The page has no robot ${file}.toml, which its address names.`);
  if (addressFile !== null && !isKnownFile) reportMissing(addressFile);
  // The robot in the address takes precedence over a stored robot.
  const isRobotInAddress = addressFile !== null || parseFragment(location.hash).has('robot');
  if (saved && session.robot.file === saved.file && !(await session.robot.restoreSaved(saved)) && !isRobotInAddress) {
    const remedy = { label: 'Download the changed robot', action: () => void downloadRobot(saved.toml, saved.floor) };
    const message = `${saved.file}.toml has changed since the last visit; your changes to the previous file are not applied.`;
    problems.setMessage('robot', message, remedy);
  }
  if (await robotText.loadFromAddress()) address.start();
  // Also if the saved robot could not be restored, because its file has changed or is gone.
  if (session.robot.toml !== '') ownRobots.putAside(saved);
  addEventListener('popstate', ({ state }) => {
    const { hash } = location;
    openRoom(hash);
    // Between the page's own entries, Back and Forward change only the room; the robot stays.
    if (state === PAGE_ENTRY_STATE) return address.scheduleUpdate();
    const file = parseFragment(hash).get('file');
    if (file === null) return void replaceRobot(async () => (await robotText.loadFromAddress(hash)) && address.start());
    if (choice.select(file)) void replaceRobot(loadChosenFile);
    else reportMissing(file);
  });
  window.lizard = session;
  // The service worker starts only after the page's first files are loaded.
  void installServiceWorker((loadNewer) => {
    element('fresh').hidden = false;
    element('fresh-take').onclick = loadNewer;
  });
  let msSinceNumbers = 0;
  let frameCount = 0;
  let hasDrawingFailed = false;
  runInRealTime(
    (ms) => {
      msSinceNumbers += ms;
      session.advance(ms);
    },
    () => {
      steer.readGamepads();
      if (!session.robot.description) return;
      if (!parts.is3d || floor.drawsAlways) floor.draw(session.robot.description.plate, recordView.chooseFrame(session.robot.last), recordView.companionFrame);
      recordView.finishDrawing();
      parts.render(session.robot.last);
      frameCount += 1;
      if (frameCount % FRAMES_PER_DRAWING === 0) {
        scope.draw();
        margins.draw(session.robot.last?.scene ?? null);
        for (const map of maps) map.draw();
      }
      if (msSinceNumbers >= 1000 / NUMBER_UPDATES_PER_SECOND) {
        msSinceNumbers = 0;
        updateNumbers();
        recordView.updateNumbers();
        measure?.updateNumbers();
        scope.updateNumbers(session.robot.last?.scene ?? null);
        margins.updateNumbers(session.robot.last?.scene ?? null);
      }
    },
    (error) => {
      // A drawing that fails once may fail in every frame.
      if (hasDrawingFailed) return;
      hasDrawingFailed = true;
      console.error(error);
      problems.setMessage('page', `The page cannot draw everything (${getMessage(error)}). Reload it to try again.`);
    },
  );
}

/** Returns a text that names the board and its robot; `hash` is the hash of the page's robot. */
function describeBoard(name: string, banner: BoardBanner | undefined, hash: string): string {
  if (banner === undefined) return `waiting for the ${name}`;
  if (banner === null) return `on a ${name} without this firmware`;
  if (banner === 'unknown') return `on a ${name} that has not restarted: press its reset button to see its robot`;
  const { robot } = banner;
  if (!robot) return `on a ${name} with this firmware but no robot: write this robot`;
  const robotLabel = `robot ${robot.name} ${robot.hash}`;
  return robot.hash === hash ? `on a ${name}, ${robotLabel}` : `on a ${name} with another robot, ${robotLabel}: choose that robot, or write this robot`;
}

openRoom(location.hash);
start().catch((error: unknown) => {
  element('where').textContent = 'The page cannot start.';
  problems.setMessage('page', getMessage(error));
});
