// The controls of the simulated world: leg drive, feet, floor, mass, servos, supply voltage, and the contacts at the
// robot's inputs.
import { canLag, type Floor, type LegDrive, type ServoModel } from '../robot';
import type { Session } from '../session';
import type { ShownRobot } from '../shown-robot';
import { element, make, showSliderText } from './elements';

/** Number of decimals of each slider's value; the unit is in the slider's label. */
const DECIMALS = { force: 1, play: 1, leaf: 1, twist: 1, friction: 2, ratio: 2, mass: 0 };
type SliderName = keyof typeof DECIMALS;
const SLIDER_NAMES = Object.keys(DECIMALS) as SliderName[];
const getSlider = (name: SliderName) => element<HTMLInputElement>(name);
const showVolts = (input: HTMLInputElement) => showSliderText(input, input.valueAsNumber.toFixed(2));

/** The label of each of the robot's inputs: the event that closes its contact. */
const CONTACT_LABELS: Record<string, string> = { button: 'button pressed', nose: 'wall at the nose' };

const driveList = element<HTMLSelectElement>('drive');
const servoList = element<HTMLSelectElement>('servos');
const servoVoltsInput = element<HTMLInputElement>('servo-volts');
const boardVoltsInput = element<HTMLInputElement>('supply');

export function setUpWorld(session: Session): void {
  driveList.addEventListener('change', () => changeFloor(session, { kind: driveList.value as LegDrive }));
  for (const name of SLIDER_NAMES) {
    const input = getSlider(name);
    input.addEventListener('input', () => showSliderText(input, input.valueAsNumber.toFixed(DECIMALS[name])));
    input.addEventListener('change', () => changeFloor(session, { [name]: input.valueAsNumber }));
  }
  element('floor-reset').addEventListener('click', () => {
    session.robot.setFloor(null);
    showRobot(session);
  });
  for (const input of [boardVoltsInput, servoVoltsInput]) input.addEventListener('input', () => showVolts(input));
  boardVoltsInput.addEventListener('change', () => session.robot.setSupply(boardVoltsInput.valueAsNumber));
  servoList.addEventListener('change', () => chooseServos(session, servoList.value));
  servoVoltsInput.addEventListener('change', () => chooseServos(session, `${servoList.value} at ${servoVoltsInput.value}`));
  session.robot.follow(() => showRobot(session));
}

/** Shows the values of the session's robot. */
function showRobot(session: Session): void {
  const { floor, description } = session.robot;
  driveList.value = floor.kind;
  for (const name of SLIDER_NAMES) {
    const input = getSlider(name);
    // The slider's range grows to include the value.
    if (floor[name] > Number(input.max)) input.max = String(floor[name]);
    if (floor[name] < Number(input.min)) input.min = String(floor[name]);
    input.value = String(floor[name]);
    showSliderText(input, floor[name].toFixed(DECIMALS[name]));
  }
  enableSliders(floor, session.robot.servos);
  servoList.replaceChildren(...description.models.map((model) => new Option(formatServoModel(model), model.name)));
  showServos(session.robot);
  boardVoltsInput.value = String(session.robot.volts);
  showVolts(boardVoltsInput);
  showInputs(session);
  const [slowVolts, stopVolts, restVolts] = description.supply;
  element('supply-note').textContent =
    `Below ${slowVolts} V, the pace is at most ${description.slow_pace} % and settings cannot be saved; below ${stopVolts} V, the robot stops; below ${restVolts} V, the pulses end.`;
}

function chooseServos(session: Session, servos: string): void {
  session.robot.setServos(servos);
  showServos(session.robot);
  enableSliders(session.robot.floor, servos);
}

/** Shows the servo model and its supply voltage: the model's own unless the user has set another. */
function showServos({ description, servos }: ShownRobot): void {
  const [name = '', supply] = servos.split(' at ');
  servoList.value = name;
  const ratings = description.models.find((model) => model.name === name)?.ratings;
  servoVoltsInput.disabled = !ratings;
  if (!ratings) return;
  const [, , , supplyVolts] = ratings;
  servoVoltsInput.max = String(Math.max(6, supplyVolts));
  servoVoltsInput.value = supply ?? String(supplyVolts);
  showVolts(servoVoltsInput);
}

/** Shows a checkbox for each of the robot's inputs; the simulated contact is closed while the box is ticked. */
function showInputs(session: Session): void {
  const boxes = session.robot.description.inputs.map(([name]) => {
    const box = make('input', { type: 'checkbox', checked: session.closedInputs.has(name), onchange: () => session.setContact(name, box.checked) });
    return make('label', {}, box, ` ${CONTACT_LABELS[name] ?? name}`);
  });
  element('inputs').replaceChildren(...boxes);
  element('inputs').hidden = boxes.length === 0;
}

/** Enables only the sliders that have an effect. */
function enableSliders(floor: Floor, servos: string): void {
  const hasSprings = floor.kind !== 'rigid';
  const canYield = hasSprings || servos !== 'ideal';
  getSlider('force').disabled = !hasSprings;
  // If neither springs nor servos yield, friction has no effect; if no foot is too long either, mass has no effect.
  getSlider('friction').disabled = !canYield;
  getSlider('mass').disabled = !canYield && floor.twist === 0;
  getSlider('leaf').disabled = floor.twist === 0;
  element('rigid-note').hidden = canYield || canLag(floor) || floor.twist !== 0;
}

/** Changes the leg drive or a slider's value. No other slider is read, because it may have rounded its value. */
function changeFloor(session: Session, changes: Partial<Floor>): void {
  const floor = { ...session.robot.floor, ...changes };
  enableSliders(floor, session.robot.servos);
  session.robot.setFloor(floor);
}

/** Formats a servo model's label in the list. */
function formatServoModel({ name, ratings }: ServoModel): string {
  if (!ratings) return 'ideal: follows its pulse at once';
  const [torqueKgCm, seconds, volts] = ratings;
  return `${name === 'own' ? 'as in robot.toml' : name}: ${torqueKgCm} kg cm, ${seconds} s for 60° at ${volts} V`;
}
