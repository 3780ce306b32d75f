// The page's robot in WebAssembly refuses invalid arguments.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { readPageFile, Robot } from './wasm.js';

const toml = await readPageFile('robot.toml', 'utf8');

test('an invalid argument is refused and changes nothing', () => {
  const robot = new Robot();
  assert.equal(robot.predict(1), null, 'no prediction without a robot');
  const { floor } = robot.load(toml);
  const firstPrediction = robot.predict(1);
  assert.ok(firstPrediction.forward > 10);
  for (const wrongFloor of [null, {}, { ...floor, kind: 'soft' }, { ...floor, twist: undefined }]) {
    assert.throws(() => robot.setFloor(wrongFloor), /Error/, JSON.stringify(wrongFloor));
  }
  assert.throws(() => robot.followPulses([1, 2, 3]), /Error/);
  assert.match(robot.load('').reason, /./);
  assert.deepEqual(robot.predict(1), firstPrediction);
  robot.setFloor({ ...floor, ratio: 0.5 });
  assert.notDeepEqual(robot.predict(1), firstPrediction);
});
