// The robot driven before a camera, as a person would wish it: a world of its own with a robot that walks other than
// predicted, hands that hide it, lines that get lost, and a link that is cut.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { importSource } from './source.js';

const { Protocol } = await importSource('measure/protocol.ts');

/**
 * Moments in a second; distance of the floor's tags from their middle, mm; and, counted from the tags, the distance at
 * which a robot is near the end, and the distance of the end that the film still measures, mm.
 */
const MOMENTS_PER_SECOND = 20;
const TAG_DISTANCE = 210;
const NEAR_MARGIN = 50;
const END_MARGIN = 200;
/** Time after which a robot that hears nothing stops, s. */
const DEADMAN_SECONDS = 0.9;
const WAYS = [
  { command: 'walk', forward: 33, turn: 0.1 },
  { command: 'back', forward: -30, turn: -0.1 },
  { command: 'left', forward: 1, turn: 20 },
  { command: 'arc left', forward: 22, turn: 7 },
];

/** Random numbers, the same in every run. */
function randomOf(seed) {
  let state = seed * 2654435761;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 2 ** 24;
  };
  return { random, between: (low, high) => low + (high - low) * random(), from: (list) => list[Math.floor(random() * list.length)] };
}

class World {
  seconds = 0;
  place = { x: 0, y: 0, heading: 0 };
  /** The gait under way and the cycles that are left of it, or what the robot does else. */
  activity = 'stand';
  left = 0;
  phase = 0;
  /** Ways over the predicted ones. */
  factor = 1;
  delay = 0.1;
  isHidden = false;
  isCut = false;
  /** Lines that arrive at the robot, and those that were sent after the cut. */
  lines = [];
  late = [];
  farthest = 0;
  timers = [];
  hands = 0;

  constructor() {
    this.protocol = new Protocol({
      ask: (line) => this.ask(line),
      now: () => this.seconds,
      wait: (seconds) => this.wait(seconds),
      predictions: () => WAYS,
      putBack: () => this.putBack(),
      say: () => {},
    });
  }

  wait(seconds) {
    return new Promise((resolve) => this.timers.push({ due: this.seconds + seconds, done: resolve }));
  }

  get back() {
    const { x, y, heading } = this.place;
    const [ahead, left] = [-x * Math.cos(heading) - y * Math.sin(heading), x * Math.sin(heading) - y * Math.cos(heading)];
    return { ahead, left, reach: TAG_DISTANCE + NEAR_MARGIN, isNear: Math.hypot(x, y) > TAG_DISTANCE + NEAR_MARGIN };
  }

  /** The robot acts at once, and its answer comes later. */
  async ask(line) {
    this.protocol.noteSent(line);
    if (this.isCut) this.late.push(line);
    else this.lines.push(line);
    const [, gait = line, count] = /^(.+?) (\d+)$/.exec(line) ?? [];
    const isMotion = gait !== 'speed';
    if (isMotion && !this.isCut) [this.activity, this.left, this.phase] = [gait, Number(count), 0];
    await this.wait(this.delay);
    if (this.isCut) return this.wait(2).then(() => false);
    if (isMotion) this.protocol.setActivity(gait);
    return true;
  }

  async putBack() {
    this.hands += 1;
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
    const gait = WAYS.find(({ command }) => command === this.activity);
    if (!gait) return;
    // Within a cycle a robot swings.
    const forward = (gait.forward * this.factor + 25 * Math.cos(2 * Math.PI * this.phase)) / MOMENTS_PER_SECOND;
    const { place } = this;
    place.heading += ((gait.turn * Math.PI) / 180) / MOMENTS_PER_SECOND;
    place.x += forward * Math.cos(place.heading);
    place.y += forward * Math.sin(place.heading);
    this.phase += 1 / MOMENTS_PER_SECOND;
    if (this.phase < this.left - 1e-9) return;
    this.activity = 'stop';
    if (this.isCut) return;
    this.protocol.noteReceived('# done');
    this.protocol.setActivity('stop');
  }

  async moment() {
    this.seconds += 1 / MOMENTS_PER_SECOND;
    this.move();
    this.farthest = Math.max(this.farthest, Math.hypot(this.place.x, this.place.y));
    this.protocol.setPlace(this.isHidden ? null : this.back);
    const due = this.timers.filter((timer) => timer.due <= this.seconds);
    this.timers = this.timers.filter((timer) => timer.due > this.seconds);
    for (const { done } of due) done();
    await new Promise(setImmediate);
  }

  /**
   * Runs a plan to its end, and five seconds on; `onMoment` is called in each moment. Returns the reason of an early
   * end.
   */
  async run(plan, onMoment = () => {}) {
    let [isOver, reason] = [false, null];
    this.protocol.setPlace(this.back);
    const runEnd = this.protocol.run(plan).catch((error) => (reason = error.message)).then(() => (isOver = true));
    for (let extraMoments = 0; extraMoments < 5 * MOMENTS_PER_SECOND; extraMoments += isOver ? 1 : 0) {
      assert.ok(this.seconds < 1000, `it goes on: ${this.lines}`);
      onMoment();
      await this.moment();
    }
    await runEnd;
    return reason;
  }
}

/** Gaits with cycles of a second. */
const gaits = (...commands) => commands.map((command) => ({ command, period: 1 }));
const PLAN = { gaits: gaits('walk', 'left', 'arc left', 'back', 'walk'), cycles: 8, speed: 100, pause: 1 };
/** Some hundred worlds, each with random places, robots and answers. */
async function runWorlds(count, act) {
  for (let seed = 1; seed <= count; seed++) {
    const chance = randomOf(seed);
    const world = new World();
    const [distance, direction] = [chance.between(0, TAG_DISTANCE + NEAR_MARGIN), chance.between(0, 2 * Math.PI)];
    world.place = { x: distance * Math.cos(direction), y: distance * Math.sin(direction), heading: chance.between(0, 2 * Math.PI) };
    world.delay = chance.between(0.01, 0.5);
    await act(world, chance, seed);
    const isWalking = WAYS.some(({ command }) => command === world.activity);
    assert.ok(!isWalking, `world ${seed}: the robot goes on with ${world.activity}`);
    assert.ok(world.farthest < TAG_DISTANCE + END_MARGIN, `world ${seed}: ${world.farthest} mm from the middle`);
  }
}

test('a robot that goes as predicted walks every gait, from the middle all cycles of it, and hands are seldom needed', async () => {
  let [hands, wholeWalks, allWalks] = [0, 0, 0];
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
      wholeWalks += end - begin > PLAN.cycles - 0.1 ? 1 : 0;
      allWalks += 1;
    }
    hands += world.hands;
  });
  assert.ok(wholeWalks > 0.8 * allWalks, `${wholeWalks} of ${allWalks} walks have all cycles`);
  assert.ok(hands < 0.5 * 60, `${hands}`);
});

test('a walk of many cycles ends at the end of the sheet, the robot comes back by itself and walks the rest', async () => {
  const world = new World();
  assert.equal(await world.run({ ...PLAN, gaits: gaits('walk'), cycles: 30 }), null);
  const walkSeconds = world.protocol.walks.map(({ during: [begin, end] }) => end - begin);
  for (const seconds of walkSeconds) assert.ok(seconds > 3.9 && seconds < 17, `${seconds} s`);
  const sum = walkSeconds.reduce((a, b) => a + b);
  assert.ok(sum > 26 && sum < 34, `${walkSeconds} s`);
  assert.ok(walkSeconds.length > 2);
  assert.deepEqual(world.lines.slice(0, 3), ['speed 100', 'walk 30', 'stand']);
  assert.match(world.lines.slice(3).join(), /^(back \d+,walk \d+(,stand)?,?)+$/);
  assert.equal(world.hands, 0);
});

test('a robot that walks farther, less far or the other way, and is hidden now and then, does not leave the sheet', () =>
  runWorlds(150, async (world, { random, from, between }) => {
    world.factor = from([-1, 0.5, 1.2, between(0.8, 1.2)]);
    const onMoment = () => {
      if (random() < 0.005) world.isHidden = true;
      else if (random() < 0.02) world.isHidden = false;
    };
    assert.equal(await world.run({ ...PLAN, cycles: from([4, 8, 20]) }, onMoment), null);
  }));

test('after a cut, a silence or a stop the robot is not driven, the reason is said, and what it walked is kept', () =>
  runWorlds(150, async (world, { from, between }, seed) => {
    const [event, eventSeconds] = [from(['', 'silent', 'stop', 'left']), between(0.5, 60)];
    let lineCount = null;
    let knownWalks = [];
    const onMoment = () => {
      if (lineCount !== null || world.seconds < eventSeconds) return;
      lineCount = world.lines.length;
      knownWalks = world.protocol.walks.slice();
      if (event === '' || event === 'silent') world.cut(event);
      else void world.ask(event === 'stop' ? event : 'left 3');
    };
    const reason = await world.run({ ...PLAN, gaits: gaits('walk', 'back', 'walk', 'back', 'walk', 'back', 'walk') }, onMoment);
    const lines = [...world.lines.slice(lineCount), ...world.late].filter((line) => line !== 'stop');
    assert.deepEqual(lines, event === 'left' ? ['left 3'] : [], `world ${seed}, ${event}`);
    assert.match(reason, { '': /cut/, silent: /silent/, stop: /stopped/, left: /the robot was sent "left 3"/ }[event]);
    assert.deepEqual(world.protocol.walks.slice(0, knownWalks.length), knownWalks);
    for (const { during: [begin, end] } of world.protocol.walks) assert.ok(begin <= end && end <= eventSeconds + world.delay + 0.1, `world ${seed}: ${begin} to ${end} s`);
  }));

test('a camera that is switched off stops a robot that walks', async () => {
  const world = new World();
  const onMoment = () => world.seconds > 4 && world.activity === 'walk' && world.protocol.stop('the camera was switched off');
  assert.equal(await world.run(PLAN, onMoment), 'the camera was switched off');
  assert.deepEqual(world.lines, ['speed 100', 'walk 8', 'stop']);
  assert.equal(world.protocol.walks.length, 1);
});
