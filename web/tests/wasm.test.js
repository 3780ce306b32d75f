// The page's robot in WebAssembly refuses invalid arguments.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { readPageFile, Robot } from './wasm.js';

const toml = await readPageFile('robot.toml', 'utf8');
/** The index of the gait `walk` in robot.toml. */
const WALK = 1;

test('an invalid argument is refused and changes nothing', () => {
  const robot = new Robot();
  assert.equal(robot.predict(WALK), null, 'no prediction without a robot');
  const { floor } = robot.load(toml);
  const firstPrediction = robot.predict(WALK);
  assert.ok(firstPrediction.forward > 10);
  for (const invalidFloor of [null, {}, { ...floor, kind: 'soft' }, { ...floor, twist: undefined }]) {
    assert.throws(() => robot.setFloor(invalidFloor), /Error/, JSON.stringify(invalidFloor));
  }
  assert.throws(() => robot.followPulses([1, 2, 3]), /Error/);
  assert.match(robot.load('').reason, /./);
  assert.deepEqual(robot.predict(WALK), firstPrediction);
  // A valid floor changes the prediction, so the previous comparison can fail.
  robot.setFloor({ ...floor, ratio: 0.5 });
  assert.notDeepEqual(robot.predict(WALK), firstPrediction);
});
