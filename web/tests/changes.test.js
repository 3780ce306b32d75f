// The user's changes are in the downloaded file and survive a reload.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { deflateRawSync } from 'node:zlib';

import { parse } from 'smol-toml';

import { address, advance, openStanding, openUnfolded, reload, sendLine, unfold, useBrowser, chooseRobot, readLength, waitForLength, typeLength, download, testPage, readToml } from './browser.js';

useBrowser();

const setSlider = (page, label, value) => page.getByLabel(label).fill(value);

async function downloadToml(page, buttonName = 'Download robot.toml') {
  const { bytes } = await download(page, page.getByRole('button', { name: buttonName }));
  return bytes.toString();
}

/** Chooses the first of the user's own robots in the list. */
const chooseOwnRobot = (page) =>
  page.evaluate(() => {
    const list = document.querySelector('#robot');
    list.querySelector('optgroup[label="your own"] option').selected = true;
    list.dispatchEvent(new Event('change'));
  });

async function openWithChanges() {
  const page = await openStanding();
  await page.getByLabel('Driven by').selectOption('strut');
  await setSlider(page, 'Pull in the strut', '2.5');
  await setSlider(page, 'Play of a leg', '0.5');
  await setSlider(page, 'Front left foot too long', '-0.6');
  await setSlider(page, 'Stiffness of a foot', '2');
  await setSlider(page, 'Pad friction', '0.5');
  await setSlider(page, 'Friction back : ahead', '1.5');
  await setSlider(page, 'Mass', '412');
  await typeLength(page, 'leg.crank', 40);
  await waitForLength(page, 'leg.crank', 40);
  return page;
}

testPage('the downloaded robot.toml has lengths, drive, feet, floor and mass', openWithChanges, async (page) => {
  const toml = await downloadToml(page);
  const { leg, feet, ground, body } = parse(toml);
  assert.deepEqual([leg.crank, leg.drive.force, leg.drive.play], [40, 2.5, 0.5]);
  assert.deepEqual([feet.twist, feet.stiffness], [-0.6, 2]);
  assert.deepEqual([ground.friction, ground.friction_back_over_forward, body.mass], [0.5, 1.5, 412]);
  assert.match(toml, /^kind = "strut"$/m);
});

async function openLengths() {
  const page = await openUnfolded('#lengths-panel');
  await page.locator('#sketch circle').first().waitFor();
  return page;
}

/** Types a length that is refused; returns the message, and the text of the button that offers another length. */
async function typeRefusedLength(page, key, value) {
  await typeLength(page, key, value);
  const offer = page.locator('#lengths-alternatives button');
  await offer.waitFor();
  return [await page.locator('#lengths-refusal').innerText(), await offer.innerText()];
}

testPage('the message about a refused length names its effect on the robot, and a button offers the nearest valid length', openLengths, async (page) => {
  const [refusalText, offerText] = await typeRefusedLength(page, 'links.l12', 80);
  assert.equal(refusalText, '80 mm is too long: in the neutral pose the left slider would hit its end stop.');
  const nearest = Number(/^Try ([0-9.]+) mm$/.exec(offerText)?.[1]);
  assert.ok(nearest > 45 && nearest < 80, offerText);
  await page.locator('#lengths-alternatives button').click();
  await waitForLength(page, 'links.l12', nearest);
  assert.equal(await page.locator('#lengths-alternatives button').count(), 0);
  // Half a millimetre more is refused, so the offered length is the nearest.
  await typeLength(page, 'links.l12', nearest + 0.5);
  await page.locator('#lengths-refusal', { hasText: `${nearest + 0.5} mm is too long` }).waitFor();
  assert.equal(await readLength(page, 'links.l12'), nearest);
});

testPage('a length is accepted after a button drops the gait that forbids it', openLengths, async (page) => {
  assert.deepEqual(await typeRefusedLength(page, 'links.l2', 60), ['60 mm is too long: in "look" the left front leg would lock.', 'Drop “look”']);
  await page.locator('#lengths-alternatives button', { hasText: 'Drop' }).click();
  await waitForLength(page, 'links.l2', 60);
  const gaits = await page.evaluate(() => window.lizard.robot.description.gaits.map(({ name }) => name));
  assert.ok(!gaits.includes('look') && gaits.includes('walk'), gaits.join());
  await page.locator('#robot-undo').click();
  await page.waitForFunction(() => window.lizard.robot.description.gaits.some(({ name }) => name === 'look'));
});

testPage('the download of an unchanged robot equals its file', () => openUnfolded('#lengths-panel'), async (page) => {
  const originalToml = await readFile(new URL('../dist/files/robot.toml', import.meta.url), 'utf8');
  assert.equal(await downloadToml(page), originalToml);
});

testPage('a reload keeps the user\'s changes', openWithChanges, async (page) => {
  await page.locator('#servos').selectOption('ideal');
  await reload(page);
  const { floor, lengths, servos } = await page.evaluate(() => {
    const { floor, description, servos } = window.lizard.robot;
    return { floor, lengths: description.lengths, servos };
  });
  const { rate, ...settings } = floor;
  const drive = { kind: 'strut', force: 2.5, play: 0.5 };
  assert.deepEqual(settings, { friction: 0.5, ratio: 1.5, mass: 412, leaf: 2, twist: -0.6, ...drive });
  assert.ok(rate > 0, 'the spring of the parts has a rate');
  assert.equal(lengths.find(({ key }) => key === 'leg.crank').value, 40);
  assert.equal(servos, 'ideal');
  assert.equal(await page.locator('#servos').inputValue(), 'ideal');
  assert.equal(await page.locator('#mass').inputValue(), '412');
});

testPage('a newer robot file replaces the user\'s stored changes, and a message reports that', openWithChanges, async (page) => {
  await page.evaluate(() => {
    const key = Object.keys(localStorage)[0];
    const saved = JSON.parse(localStorage.getItem(key));
    localStorage.setItem(key, JSON.stringify({ ...saved, original: `${saved.original}\n` }));
  });
  // The robot in the address would restore the changes, so the page is opened without it.
  await page.waitForFunction(() => location.hash.includes('robot='));
  await page.goto(address());
  await page.waitForFunction(() => window.lizard);
  await page.locator('#problems', { hasText: 'robot.toml has changed since the last visit' }).waitFor();
  assert.equal(await readToml(page), await readFile(new URL('../dist/files/robot.toml', import.meta.url), 'utf8'));
  const { leg, body } = parse(await downloadToml(page, 'Download the changed robot'));
  assert.deepEqual([leg.crank, body.mass], [40, 412], 'the changes are not lost');
  await reload(page);
  await chooseOwnRobot(page);
  await waitForLength(page, 'leg.crank', 40);
});

testPage('a changed robot whose file the page no longer has stays in the list of robots', openWithChanges, async (page) => {
  await page.evaluate(() => {
    const key = Object.keys(localStorage)[0];
    localStorage.setItem(key, JSON.stringify({ ...JSON.parse(localStorage.getItem(key)), file: 'gone' }));
  });
  await page.waitForFunction(() => location.hash.includes('robot='));
  await page.goto(address());
  await page.waitForFunction(() => window.lizard);
  await chooseOwnRobot(page);
  await waitForLength(page, 'leg.crank', 40);
});

testPage('a robot from a link or a file has its own floor, springs and mass', openWithChanges, async (page) => {
  const largePath = new URL('../dist/files/large.toml', import.meta.url).pathname;
  const link = `${address()}#robot=${deflateRawSync(await readFile(largePath)).toString('base64url')}`;
  const setMass = async (text) => {
    await setSlider(page, 'Mass', text);
    await page.waitForFunction((mass) => window.lizard.robot.floor.mass === mass, Number(text));
  };
  const waitForOwnFloor = () => page.waitForFunction(() => {
    const { robot } = window.lizard ?? {};
    return robot?.description.name === 'large' && JSON.stringify(robot.floor) === JSON.stringify(robot.description.floor);
  });
  await page.goto('about:blank');
  await page.goto(link);
  await waitForOwnFloor();
  await chooseRobot(page, 'robot');
  await setMass('400');
  await page.locator('#robot-open').setInputFiles(largePath);
  await waitForOwnFloor();
});

testPage('the pace slider shows the robot\'s pace after a typed line and after a reset', openStanding, async (page) => {
  await advance(page, 3000);
  await sendLine(page, 'speed 35', 'ok speed 35');
  const slider = page.locator('#speed');
  assert.equal(await slider.inputValue(), '35');
  await page.locator('#reset').click();
  // The page has not requested a status yet.
  await advance(page, 2000);
  assert.equal(await slider.inputValue(), '100');
  assert.equal(await page.locator('#speed-out').innerText(), '100 %');
  assert.match(await sendLine(page, 'status', 'ok gait=stand'), / speed=100( |$)/);
});

testPage("the servos' load follows the robot's pace and the servos' supply", () => openUnfolded('#power'), async (page) => {
  const readHighestLoad = async (pace) => {
    const note = page.locator('#load-note', { hasText: `line at a pace of ${pace} %` });
    await note.waitFor();
    return Number((await note.innerText()).match(/ (\d\.\d\d) of/)[1]);
  };
  await advance(page, 3000);
  const fullPaceLoad = await readHighestLoad(100);
  await sendLine(page, 'speed 50', 'ok speed 50');
  const halfPaceLoad = await readHighestLoad(50);
  // The loads of the hardest gait in docs/gaits.md.
  assert.deepEqual([fullPaceLoad, halfPaceLoad], [0.82, 0.51]);
  // Compares with the loads in docs/gaits.md to a hundredth; a load of at least 0.9 has a mark.
  const assertLoads = async (...expectedLoads) => {
    const labels = await page.locator('#gaits .load').allInnerTexts();
    assert.equal(labels.length, expectedLoads.length);
    for (const [n, label] of labels.entries()) {
      const load = Number(label.match(/load (\d\.\d\d)$/)[1]);
      assert.ok(Math.abs(load - expectedLoads[n]) < 0.011, `${label}, expected load ${expectedLoads[n]}`);
      assert.equal(label.startsWith('⚠'), load >= 0.9, label);
    }
  };
  await assertLoads(0.45, 0.49, 0.51, 0.45, 0.5, 0.5, 0.45, 0.45, 0.24);
  await sendLine(page, 'speed 100', 'ok speed 100');
  await setSlider(page, 'Supply of the servos', '4.2');
  await page.locator('#load-note.warning').waitFor();
  await page.waitForFunction(() => [...document.querySelectorAll('#gaits .load')].at(-1).textContent > 'load 0.3');
  await assertLoads(0.83, 0.92, 0.93, 0.83, 0.93, 0.93, 0.82, 0.82, 0.33);
  // Another servo model sets its own supply.
  await page.locator('#servos').selectOption('MG90S');
  assert.equal(await page.getByLabel('Supply of the servos').inputValue(), '4.8');
});

testPage('with rigid legs and ideal servos, sliders without an effect are disabled, and a note gives the reason', openStanding, async (page) => {
  for (const panel of ['#world', '#power']) await unfold(page, panel);
  const note = page.getByText('The legs are rigid, the servos ideal, and the feet stand evenly: friction and mass cancel out');
  assert.equal(await note.isVisible(), false, 'with real servos, friction and mass matter');
  assert.ok(await page.getByLabel('Pad friction').isEnabled());
  await page.locator('#servos').selectOption('ideal');
  assert.ok(await note.isVisible());
  for (const label of ['Pad friction', 'Mass', 'Pull in the strut']) assert.ok(await page.getByLabel(label).isDisabled(), label);
  assert.ok(await page.getByLabel('Friction back : ahead').isEnabled());
  // With a foot that is too long, the weight and the feet's stiffness matter.
  await setSlider(page, 'Front left foot too long', '1');
  assert.equal(await note.isVisible(), false);
  for (const label of ['Mass', 'Stiffness of a foot']) assert.ok(await page.getByLabel(label).isEnabled(), label);
  assert.ok(await page.getByLabel('Pad friction').isDisabled());
  await setSlider(page, 'Front left foot too long', '0');
  assert.ok(await page.getByLabel('Stiffness of a foot').isDisabled());
  await page.getByLabel('Driven by').selectOption('strut');
  assert.equal(await note.isVisible(), false);
  for (const label of ['Pad friction', 'Mass', 'Pull in the strut']) assert.ok(await page.getByLabel(label).isEnabled(), label);
});

testPage('a slider changes no value but its own', openStanding, async (page) => {
  await page.evaluate(() => window.lizard.robot.change(window.lizard.robot.toml, { ...window.lizard.robot.floor, friction: 0.53 }));
  await setSlider(page, 'Mass', '412');
  const { mass, friction } = await page.evaluate(() => window.lizard.robot.floor);
  assert.deepEqual({ mass, friction }, { mass: 412, friction: 0.53 });
});

testPage('the page has stored predictions for unchanged robots, and computes new ones after a change', openStanding, async (page) => {
  const countWorkers = () => page.workers().filter((worker) => worker.url().includes('robot-worker')).length;
  const readNotes = () => page.locator('#gaits button[data-command] small').allInnerTexts();
  const robots = await page.locator('#robot option').evaluateAll((options) => options.map(({ value }) => value));
  assert.ok(robots.includes('own-gaits') && robots.length > 4);
  for (const name of robots) {
    await chooseRobot(page, name);
    const predicted = await page.evaluate(() => {
      const { wasm, description } = window.lizard.robot;
      return description.gaits.map((_, gait) => wasm.predict(gait));
    });
    const shownNotes = await readNotes();
    for (const [n, { forward, turn }] of predicted.entries()) {
      const forwardTexts = forward === null ? ['may drift'] : Math.abs(forward) >= 0.5 ? [`${forward.toFixed(1)} mm`] : [];
      const turnTexts = turn !== null && Math.abs(turn) >= 0.05 ? [`${turn.toFixed(1)}°`] : [];
      assert.equal(shownNotes[n], [...forwardTexts, ...turnTexts].join(', '), `${name}, gait ${n}`);
    }
  }
  assert.equal(countWorkers(), 0, 'no worker was started');

  await chooseRobot(page, 'robot');
  const [, walkNote] = await readNotes();
  await setSlider(page, 'Friction back : ahead', '1.5');
  await page.waitForFunction((walkNote) => document.querySelector('#gaits button[data-command="walk"] small').textContent !== walkNote, walkNote);
  assert.equal(countWorkers(), 1);
  await page.locator('#floor-reset').click();
  await page.waitForFunction((walkNote) => document.querySelector('#gaits button[data-command="walk"] small').textContent === walkNote, walkNote);
});
