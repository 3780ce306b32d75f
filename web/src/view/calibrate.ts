// The servo calibration panel: `cal` reads the settings, the inputs change them, and `save` stores them.
import { loadBoardModule } from '../board-module';
import { follow } from '../follow';
import type { ServoSettings } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { WORDS } from '../words';
import { element, make } from './elements';
import { isShown } from './rooms';

type ShowSettings = (settings: ServoSettings) => void;

export function setUpCalibration(session: Session): void {
  const message = element('cal-message');
  /** For each servo, the function that shows its settings; empty before the first settings. */
  let showSettingsByServo: ShowSettings[] = [];
  /** True if the robot's settings may differ from the shown ones: after a command without an answer, or a restart. */
  let mayBeOutdated = false;
  /** Number of lines that the panel has sent. */
  let sentCount = 0;

  /** Reads the robot's settings and shows them. */
  async function read(): Promise<void> {
    const previousCount = sentCount;
    const answer = await session.board.ask(WORDS.cal, true);
    const board = await loadBoardModule().catch((error: unknown) => {
      message.textContent = getMessage(error);
      return null;
    });
    const settings = answer && board?.readCalibration(answer.notes);
    if (!settings) return;
    // The user has changed a setting meanwhile.
    if (sentCount !== previousCount) return read();
    mayBeOutdated = false;
    if (showSettingsByServo.length === 0) showSettingsByServo = settings.servos.map((_, index) => addServo(index + 1, send));
    settings.servos.forEach((servo, index) => showSettingsByServo[index](servo));
  }

  async function send(line: string): Promise<void> {
    sentCount += 1;
    const answer = await session.board.ask(line);
    message.textContent = answer?.text ?? '';
    mayBeOutdated ||= answer === null;
    if (answer && !answer.ok) await read();
  }

  element('cal-read').addEventListener('click', () => void read());
  element('cal-save').addEventListener('click', () => void send(WORDS.save));
  for (const word of [WORDS.load, WORDS.factory]) element(`cal-${word}`).addEventListener('click', () => void send(word).then(read));
  const panel = element<HTMLDetailsElement>('calibrate');
  panel.addEventListener('toggle', () => isShown(panel) && void read());
  const { link, bannerCount, status } = session.state;
  follow([link, bannerCount], () => (mayBeOutdated ||= showSettingsByServo.length > 0));
  // The robot answers again.
  status.subscribe((newStatus) => newStatus && mayBeOutdated && void read());
}

/** Adds the inputs of a servo, which send its settings; returns the function that shows settings in them. */
function addServo(servoNumber: number, send: (line: string) => Promise<void>): ShowSettings {
  const trimInput = make('input', { type: 'range', min: '-20', max: '20', step: '0.25' });
  const trimText = make('output', {});
  const showTrim = () => (trimText.textContent = `${Number(trimInput.value).toFixed(2)}°`);
  trimInput.addEventListener('input', showTrim);
  const makeNumber = (step: string) => make('input', { type: 'number', step });
  const minInput = makeNumber('1');
  const maxInput = makeNumber('1');
  const scaleInput = makeNumber('0.01');
  const dirList = make('select', {}, new Option('left (+)', '+'), new Option('right (−)', '-'));
  const numbers = make(
    'div',
    { className: 'numbers' },
    make('label', {}, 'from, deg', minInput),
    make('label', {}, 'to, deg', maxInput),
    make('label', {}, 'µs per deg', scaleInput),
    make('label', {}, 'longer pulse turns', dirList),
  );
  const trimLabel = make('label', { className: 'slider' }, 'trim ', trimInput, trimText);
  element('calibration').append(make('fieldset', {}, make('legend', {}, `A${servoNumber}`), trimLabel, numbers));
  const sendOnChange = (input: HTMLElement, formatLine: () => string) => input.addEventListener('change', () => void send(formatLine()));
  sendOnChange(trimInput, () => `${WORDS.trim} ${servoNumber} ${trimInput.value}`);
  for (const input of [minInput, maxInput]) sendOnChange(input, () => `${WORDS.limit} ${servoNumber} ${minInput.value} ${maxInput.value}`);
  sendOnChange(scaleInput, () => `${WORDS.scale} ${servoNumber} ${scaleInput.value}`);
  sendOnChange(dirList, () => `${WORDS.dir} ${servoNumber} ${dirList.value}`);
  return ({ trim, limit, dir, scale }) => {
    trimInput.value = String(trim);
    showTrim();
    scaleInput.value = String(scale);
    [minInput.value, maxInput.value] = limit.map(String);
    dirList.value = dir;
  };
}
