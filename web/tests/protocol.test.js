// The protocol that drives the robot in front of a camera, in a simulated world: a robot that does not walk as
// predicted, hands that hide it, late answers, and a link that is cut.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { importSource } from './source.js';

const { Protocol } = await importSource('measure/protocol.ts');

const STEPS_PER_SECOND = 20;
/** Distance of the sheet's tags from the middle of the sheet, mm. */
const TAG_DISTANCE_MM = 210;
/** Distance beyond the tags from which on a robot is near the edge of the sheet, mm. */
const NEAR_MARGIN_MM = 50;
/** Distance beyond the tags up to which a video is measured, mm. */
const END_MARGIN_MM = 200;
/** Time after which a robot that receives nothing stops. */
const DEADMAN_SECONDS = 0.9;
/** Predicted displacements in a cycle, mm and deg. */
const PREDICTIONS = [
  { command: 'walk', forward: 33, turn: 0.1 },
  { command: 'back', forward: -30, turn: -0.1 },
  { command: 'left', forward: 1, turn: 20 },
  { command: 'arc left', forward: 22, turn: 7 },
];

/** Makes a generator of random numbers, which are the same in every run. */
function makeGenerator(seed) {
  let state = seed * 2654435761;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 2 ** 24;
  };
  return { random, between: (low, high) => low + (high - low) * random(), pick: (list) => list[Math.floor(random() * list.length)] };
}

/** A simulated robot on the sheet, with its link and its camera, and the protocol that drives it. */
class World {
  seconds = 0;
  place = { x: 0, y: 0, heading: 0 };
  /** The running gait, or the last command. */
  activity = 'stand';
  /** Number of cycles after which the gait ends. */
  cycleCount = 0;
  /** Cycles of the gait that have passed. */
  phase = 0;
  /** Ratio of the distance of a cycle to the predicted distance. */
  distanceFactor = 1;
  /** Delay of the robot's answers, s. */
  answerDelay = 0.1;
  isHidden = false;
  isCut = false;
  /** Lines that the robot received. */
  lines = [];
  linesAfterCut = [];
  /** Largest distance of the robot from the middle of the sheet, mm. */
  maxDistanceMm = 0;
  timers = [];
  putBackCount = 0;

  constructor() {
    this.protocol = new Protocol({
      ask: (line) => this.ask(line),
      now: () => this.seconds,
      wait: (seconds) => this.wait(seconds),
      predictions: () => PREDICTIONS,
      putBack: () => this.putBack(),
      showProgress: () => {},
    });
  }

  wait(seconds) {
    return new Promise((resolve) => this.timers.push({ dueSeconds: this.seconds + seconds, resolve }));
  }

  /** The vector from the robot to the middle of the sheet, mm, in the robot's own coordinates. */
  get offsetToCentre() {
    const { x, y, heading } = this.place;
    const [forward, left] = [-x * Math.cos(heading) - y * Math.sin(heading), x * Math.sin(heading) - y * Math.cos(heading)];
    return { forward, left, reach: TAG_DISTANCE_MM + NEAR_MARGIN_MM, isNearEdge: Math.hypot(x, y) > TAG_DISTANCE_MM + NEAR_MARGIN_MM };
  }

  /** Sends a line to the robot, which acts at once and answers later. */
  async ask(line) {
    this.protocol.handleSent(line);
    if (this.isCut) this.linesAfterCut.push(line);
    else this.lines.push(line);
    const [, gait = line, cycleCount] = /^(.+?) (\d+)$/.exec(line) ?? [];
    const isMotion = gait !== 'speed';
    if (isMotion && !this.isCut) [this.activity, this.cycleCount, this.phase] = [gait, Number(cycleCount), 0];
    await this.wait(this.answerDelay);
    if (this.isCut) return this.wait(2).then(() => false);
    if (isMotion) this.protocol.setActivity(gait);
    return true;
  }

  async putBack() {
    this.putBackCount += 1;
    await Promise.race([this.wait(3), new Promise((resolve) => (this.protocol.onEnd = resolve))]);
    this.isHidden = false;
    this.place = { x: 10, y: -15, heading: 2 };
    await this.wait(0.2);
  }

  cut(cause) {
    this.isCut = true;
    if (cause === 'silent') this.protocol.stop('the robot is silent');
    else this.protocol.setActivity('');
    void this.wait(DEADMAN_SECONDS).then(() => (this.activity = 'stop'));
  }

  move() {
    const gait = PREDICTIONS.find(({ command }) => command === this.activity);
    if (!gait) return;
    // Within a cycle a robot also sways back and forth.
    const forward = (gait.forward * this.distanceFactor + 25 * Math.cos(2 * Math.PI * this.phase)) / STEPS_PER_SECOND;
    const { place } = this;
    place.heading += ((gait.turn * Math.PI) / 180) / STEPS_PER_SECOND;
    place.x += forward * Math.cos(place.heading);
    place.y += forward * Math.sin(place.heading);
    this.phase += 1 / STEPS_PER_SECOND;
    if (this.phase < this.cycleCount - 1e-9) return;
    this.activity = 'stop';
    if (this.isCut) return;
    this.protocol.handleReceived('# done');
    this.protocol.setActivity('stop');
  }

  async step() {
    this.seconds += 1 / STEPS_PER_SECOND;
    this.move();
    this.maxDistanceMm = Math.max(this.maxDistanceMm, Math.hypot(this.place.x, this.place.y));
    this.protocol.setOffset(this.isHidden ? null : this.offsetToCentre);
    const dueTimers = this.timers.filter((timer) => timer.dueSeconds <= this.seconds);
    this.timers = this.timers.filter((timer) => timer.dueSeconds > this.seconds);
    for (const { resolve } of dueTimers) resolve();
    await new Promise(setImmediate);
  }

  /**
   * Runs a plan to its end, and then for five more seconds. Calls `onStep` before each step. Returns the reason for an
   * early end, or null.
   */
  async run(plan, onStep = () => {}) {
    let [isOver, reason] = [false, null];
    this.protocol.setOffset(this.offsetToCentre);
    const runEnd = this.protocol.run(plan).catch((error) => (reason = error.message)).then(() => (isOver = true));
    for (let extraSteps = 0; extraSteps < 5 * STEPS_PER_SECOND; extraSteps += isOver ? 1 : 0) {
      assert.ok(this.seconds < 1000, `the plan does not end: ${this.lines}`);
      onStep();
      await this.step();
    }
    await runEnd;
    return reason;
  }
}

/** Makes the gaits of a plan, with cycles of a second. */
const makeGaits = (...commands) => commands.map((command) => ({ command, period: 1 }));
const PLAN = { gaits: makeGaits('walk', 'left', 'arc left', 'back', 'walk'), cycles: 8, speed: 100, pause: 1 };
/**
 * Runs `act` in worlds with a random place of the robot and a random delay of its answers. Checks that the robot stays
 * on the sheet and does not walk at the end.
 */
async function runWorlds(count, act) {
  for (let seed = 1; seed <= count; seed++) {
    const generator = makeGenerator(seed);
    const world = new World();
    const [distance, direction] = [generator.between(0, TAG_DISTANCE_MM + NEAR_MARGIN_MM), generator.between(0, 2 * Math.PI)];
    world.place = { x: distance * Math.cos(direction), y: distance * Math.sin(direction), heading: generator.between(0, 2 * Math.PI) };
    world.answerDelay = generator.between(0.01, 0.5);
    await act(world, generator, seed);
    const isWalking = PREDICTIONS.some(({ command }) => command === world.activity);
    assert.ok(!isWalking, `world ${seed}: the robot still does ${world.activity}`);
    assert.ok(world.maxDistanceMm < TAG_DISTANCE_MM + END_MARGIN_MM, `world ${seed}: ${world.maxDistanceMm} mm from the middle`);
  }
}

test('a robot that walks as predicted walks every gait, most of them with all cycles, and is seldom put back by hand', async () => {
  let [putBackCount, completeWalkCount, walkCount] = [0, 0, 0];
  await runWorlds(60, async (world, _, seed) => {
    assert.equal(await world.run(PLAN), null);
    const { walks } = world.protocol;
    const names = walks.map(({ gait }) => gait);
    assert.deepEqual(names.filter((name, i) => name !== names[i - 1]), PLAN.gaits.map(({ command }) => command), `world ${seed}`);
    for (const [i, { gait, during: [begin, end] }] of walks.entries()) {
      assert.ok(i === 0 || begin > walks[i - 1].during[1] + PLAN.pause - 0.1);
      assert.ok(end - begin < PLAN.cycles + 0.7, `world ${seed}: ${end - begin} s`);
      const gaitSeconds = walks.filter((walk) => walk.gait === gait).map(({ during: [from, to] }) => to - from);
      assert.ok(gaitSeconds.reduce((a, b) => a + b) > PLAN.cycles - 4, `world ${seed}: ${gait}, ${gaitSeconds} s`);
      completeWalkCount += end - begin > PLAN.cycles - 0.1 ? 1 : 0;
      walkCount += 1;
    }
    putBackCount += world.putBackCount;
  });
  assert.ok(completeWalkCount > 0.8 * walkCount, `${completeWalkCount} of ${walkCount} walks have all cycles`);
  assert.ok(putBackCount < 0.5 * 60, `${putBackCount}`);
});

test('a walk of many cycles is interrupted at the end of the sheet, and the robot returns by itself and walks the rest', async () => {
  const world = new World();
  assert.equal(await world.run({ ...PLAN, gaits: makeGaits('walk'), cycles: 30 }), null);
  const walkSeconds = world.protocol.walks.map(({ during: [begin, end] }) => end - begin);
  for (const seconds of walkSeconds) assert.ok(seconds > 3.9 && seconds < 17, `${seconds} s`);
  const totalSeconds = walkSeconds.reduce((a, b) => a + b);
  assert.ok(totalSeconds > 26 && totalSeconds < 34, `${walkSeconds} s`);
  assert.ok(walkSeconds.length > 2);
  assert.deepEqual(world.lines.slice(0, 3), ['speed 100', 'walk 30', 'stand']);
  assert.match(world.lines.slice(3).join(), /^(back \d+,walk \d+(,stand)?,?)+$/);
  assert.equal(world.putBackCount, 0);
});

test('a robot that walks too far, too little or backward, and is sometimes hidden, does not leave the sheet', () =>
  runWorlds(150, async (world, { random, pick, between }) => {
    world.distanceFactor = pick([-1, 0.5, 1.2, between(0.8, 1.2)]);
    const onStep = () => {
      if (random() < 0.005) world.isHidden = true;
      else if (random() < 0.02) world.isHidden = false;
    };
    assert.equal(await world.run({ ...PLAN, cycles: pick([4, 8, 20]) }, onStep), null);
  }));

test('after a cut, a silence or a line of the user the robot is not driven, and its walks are kept', () =>
  runWorlds(150, async (world, { pick, between }, seed) => {
    const [event, eventSeconds] = [pick(['cut', 'silent', 'stop', 'left']), between(0.5, 60)];
    let lineCount = null;
    let knownWalks = [];
    const onStep = () => {
      if (lineCount !== null || world.seconds < eventSeconds) return;
      lineCount = world.lines.length;
      knownWalks = world.protocol.walks.slice();
      if (event === 'cut' || event === 'silent') world.cut(event);
      else void world.ask(event === 'stop' ? event : 'left 3');
    };
    const reason = await world.run({ ...PLAN, gaits: makeGaits('walk', 'back', 'walk', 'back', 'walk', 'back', 'walk') }, onStep);
    const lines = [...world.lines.slice(lineCount), ...world.linesAfterCut].filter((line) => line !== 'stop');
    assert.deepEqual(lines, event === 'left' ? ['left 3'] : [], `world ${seed}, ${event}`);
    assert.match(reason, { cut: /cut/, silent: /silent/, stop: /stopped/, left: /the robot was sent "left 3"/ }[event]);
    assert.deepEqual(world.protocol.walks.slice(0, knownWalks.length), knownWalks);
    for (const { during: [begin, end] } of world.protocol.walks) assert.ok(begin <= end && end <= eventSeconds + world.answerDelay + 0.1, `world ${seed}: ${begin} to ${end} s`);
  }));

test('a camera that is switched off stops a robot that walks', async () => {
  const world = new World();
  const onStep = () => world.seconds > 4 && world.activity === 'walk' && world.protocol.stop('the camera was switched off');
  assert.equal(await world.run(PLAN, onStep), 'the camera was switched off');
  assert.deepEqual(world.lines, ['speed 100', 'walk 8', 'stop']);
  assert.equal(world.protocol.walks.length, 1);
});
