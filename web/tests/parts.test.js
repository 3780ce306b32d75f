// The parts in the page equal those of `lizard parts`: the same files and the same steps of the guide. They are shown
// in the robot's pose, and loaded only when their panel is opened.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { readFile, readdir, writeFile } from 'node:fs/promises';
import { join, relative, resolve } from 'node:path';
import { before } from 'node:test';
import { promisify } from 'node:util';

import { unzipSync } from 'fflate';

import { advance, openBlankPage, address, openStanding, openUnfolded, sendLine, unfold, withTimeout, repeatUntil, useBrowser, typeLength, download, testPage, readToml } from './browser.js';
import { makeFolder } from './temporary-folder.js';

const ROOT = new URL('../../', import.meta.url).pathname;

const folder = await makeFolder();
const runLizard = (command, ...args) => withTimeout(`lizard ${command}`, promisify(execFile)(resolve(ROOT, process.env.LIZARD), [command, ...args]));

useBrowser();
before(() => runLizard('parts', folder, '--robot', join(ROOT, 'robot.toml')));

/** Returns the paths of the files in a folder, relative to the folder. */
async function listPaths(root) {
  const entries = await readdir(root, { recursive: true, withFileTypes: true });
  return entries.filter((entry) => entry.isFile()).map(({ parentPath, name }) => relative(root, join(parentPath, name)));
}

const findMessage = (page) => page.locator('#parts-message');

async function openParts() {
  const page = await openUnfolded('#parts');
  await page.getByText('Click a part for its name').waitFor();
  await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
  return page;
}

/** Clicks on the picture at a fraction of its width and height, and returns the message. */
async function clickAt(page, xFraction, yFraction) {
  const { x, y, width, height } = await page.locator('#canvas-3d').boundingBox();
  await page.mouse.click(x + xFraction * width, y + yFraction * height);
  return findMessage(page).innerText();
}

/** Turns the view to look from straight above. */
async function lookFromAbove(page) {
  for (let n = 0; n < 12; n++) await page.locator('#canvas-3d').press('ArrowUp');
}

testPage('the page reports an unprintable length with the nearest length that lizard parts accepts', () => openUnfolded('#lengths-panel'), async (page) => {
  const length = await typeLength(page, 'leg.crank', 46);
  await page.locator('#fit-message', { hasText: /^The parts fit: no two come closer to each other than \d\.\d\d mm\.$/ }).waitFor();
  await typeLength(page, 'leg.crank', 52);
  await page.locator('#fit-message', { hasText: /^These lengths cannot be printed: .* would overlap by [\d.]+ mm\.$/ }).waitFor();
  const useButton = page.locator('#fit-use');
  await useButton.waitFor();
  const nearestMm = Number(/ ([\d.]+)$/.exec(await useButton.innerText())[1]);
  assert.ok(nearestMm > 46 && nearestMm < 52, `${nearestMm} mm`);

  const trialFolder = await makeFolder();
  // The fit of the whole robot is proved before the parts of a corner are made.
  const makeParts = async (mm) => {
    const path = join(trialFolder, 'robot.toml');
    const toml = await page.evaluate((mm) => {
      const { wasm, toml } = window.lizard.robot;
      return wasm.constructor.tryLengths(toml, [['leg.crank', mm], ['leg.follower', mm]], false).text;
    }, mm);
    await writeFile(path, toml);
    return runLizard('parts', join(trialFolder, 'parts'), '--corner', '--robot', path).then(() => 'made', ({ stderr }) => stderr);
  };
  assert.equal(await makeParts(nearestMm), 'made');
  assert.match(await makeParts(nearestMm + 0.5), /overlap|may come as near as/);

  await useButton.click();
  await page.locator('#fit-message', { hasText: /^The parts fit/ }).waitFor();
  assert.equal(await length.inputValue(), String(nearestMm));
  assert.equal(await useButton.isHidden(), true);

  // The marks of the slider are at the shortest and the longest length that can be printed.
  const printedNote = page.locator('#length-printed', { hasText: /^Printable from [\d.]+ to [\d.]+ mm\.$/ });
  await printedNote.waitFor();
  const [, shortestMm, longestMm] = /from ([\d.]+) to ([\d.]+) mm/.exec(await printedNote.innerText());
  assert.equal(Number(longestMm), nearestMm);
  assert.equal(await makeParts(Number(shortestMm)), 'made');
  const { endsMm, marks } = await page.locator('#length-slide').evaluate((slide) => {
    const { style } = document.querySelector('#length-marks');
    return { endsMm: [Number(slide.min), Number(slide.max)], marks: ['--from', '--to'].map((name) => Number.parseFloat(style.getPropertyValue(name))) };
  });
  const computeLength = (percent) => endsMm[0] + ((endsMm[1] - endsMm[0]) * percent) / 100;
  assert.deepEqual(marks.map(computeLength).map((mm) => Math.round(mm * 100) / 100), [Number(shortestMm), nearestMm]);
  assert.ok(endsMm[0] <= Number(shortestMm) && endsMm[1] > nearestMm, `the slider: ${endsMm} mm`);
});

testPage('colliding parts are red in 3D while a length is dragged, and the page shows their overlap in mm', () => openUnfolded('#lengths-panel'), async (page) => {
  await page.locator('#button-3d').click();
  await page.getByText('Click a part for its name').waitFor();
  const slider = page.locator('#length-slide');
  await slider.focus();
  await page.waitForFunction(() => Number(document.querySelector('#length-slide').max) > 52);
  const countRedPixels = async () => {
    const picture = (await page.locator('#canvas-3d').screenshot()).toString('base64');
    return page.evaluate(async (picture) => {
      const bytes = Uint8Array.from(atob(picture), (letter) => letter.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      let redCount = 0;
      for (let n = 0; n < data.length; n += 4) {
        const [r, g, b] = data.subarray(n, n + 3);
        // The orange of the legs contains more green.
        if (r > 90 && r > 3 * g && r > 3 * b) redCount += 1;
      }
      return redCount;
    }, picture);
  };
  const initialRedCount = await countRedPixels();
  const previousToml = await readToml(page);
  const dragTo = (mm) => slider.evaluate((slider, mm) => ((slider.value = String(mm)), slider.dispatchEvent(new Event('input'))), mm);
  await dragTo(52);
  const message = page.locator('#fit-message', { hasText: /^These lengths cannot be printed: .* would overlap by [\d.]+ mm\.$/ });
  await message.waitFor();
  const [, pair, overlapMm] = /printed: (.*) would overlap by ([\d.]+) mm/.exec(await message.innerText());
  await page.locator('#parts-message', { hasText: `${pair} overlap by ${overlapMm} mm.` }).waitFor();
  assert.equal(await readToml(page), previousToml, 'the slider is not released yet');
  // The stop button is red, too. The picture follows the slider after a moment.
  const hasRedParts = async () => (await countRedPixels()) > initialRedCount + 50;
  await repeatUntil('red parts', hasRedParts, () => page.waitForTimeout(200));
  // At the old length the parts fit again.
  await dragTo(45);
  await page.locator('#fit-message', { hasText: /^The parts fit/ }).waitFor();
  await repeatUntil('no red parts', async () => !(await hasRedParts()), () => page.waitForTimeout(200));
});

testPage('the page lists the files that a changed length affects, and downloads only these files', () => openUnfolded('#parts'), async (page) => {
  assert.ok(await page.locator('#parts-changed').isHidden(), 'nothing is changed');
  assert.equal(await page.evaluate(() => window.lizard.robot.change(window.lizard.robot.wasm.constructor.tryLengths(window.lizard.robot.toml, [['leg.crank', 46], ['leg.follower', 46]], false).text)), null);
  const savedFile = await download(page, page.locator('#parts-changed'));
  assert.equal(savedFile.name, 'robot-changed-parts.zip');
  const archive = unzipSync(savedFile.bytes);
  const changedFolder = await makeFolder();
  const path = join(changedFolder, 'robot.toml');
  await writeFile(path, await readToml(page));
  await runLizard('parts', join(changedFolder, 'parts'), '--robot', path);
  const paths = await listPaths(join(changedFolder, 'parts'));
  const isSame = async (name) => {
    const [changedBytes, originalBytes] = await Promise.all([join(changedFolder, 'parts', name), join(folder, name)].map((file) => readFile(file).catch(() => Buffer.alloc(0))));
    return changedBytes.equals(originalBytes);
  };
  const changedNames = [];
  for (const name of paths) if (!(await isSame(name))) changedNames.push(name);
  assert.deepEqual(Object.keys(archive).sort(), changedNames.sort());
  assert.ok(changedNames.length > 5 && changedNames.length < paths.length - 20, `${changedNames.length} of ${paths.length}`);
  assert.deepEqual((await page.locator('#files-list li').allInnerTexts()).sort(), changedNames.sort());
  assert.match(await page.locator('#files-message').innerText(), new RegExp(`^${changedNames.length} of ${paths.length} files differ from the files of robot\\.toml:`));
});

testPage('opening the page loads no parts', openBlankPage, async (page) => {
  const names = [];
  page.on('response', (response) => names.push(response.url().replace(address(), '')));
  await page.goto(address());
  await page.waitForFunction(() => window.lizard);
  assert.ok(names.includes('files/lizard.wasm'), names.join(' '));
  const earlyNames = names.filter((name) => /parts\.wasm|tune\.wasm|robot-view|make-parts|worker-.*parts/.test(name));
  assert.deepEqual(earlyNames, []);
  await unfold(page, '#parts');
  await page.getByText('Click a part for its name').waitFor();
  assert.ok(names.includes('files/parts.wasm') && names.some((name) => name.includes('robot-view')));
});

testPage('the archive has the files of lizard parts, byte for byte', () => openUnfolded('#parts'), async (page) => {
  // Every message is recorded when it appears, because polling a busy browser would miss some.
  await page.evaluate(() => {
    const box = document.querySelector('#files-message');
    window.shownMessages = [];
    new MutationObserver(() => window.shownMessages.push(box.textContent)).observe(box, { childList: true });
    // Reports of the progress have their own port. On a busy machine they may arrive after the files, as they do here.
    const { addEventListener } = MessagePort.prototype;
    window.delayedReports = [];
    MessagePort.prototype.addEventListener = function (type, listener) {
      addEventListener.call(this, type, (event) => (box.textContent.startsWith('Making') ? window.delayedReports.push(() => listener(event)) : listener(event)));
    };
  });
  const savedFile = await download(page, page.getByRole('button', { name: 'Download all files' }));
  const progress = await page.evaluate(() => window.shownMessages);
  assert.ok((await page.evaluate(() => window.delayedReports.map((report) => report()).length)) > 10);
  assert.ok(progress.some((text) => /^Proving that no two parts collide: [0-9]+ of [0-9]+\.$/.test(text)), progress.join(' '));
  assert.equal(savedFile.name, 'robot-parts.zip');
  const archive = unzipSync(savedFile.bytes);
  const paths = await listPaths(folder);
  assert.deepEqual(Object.keys(archive).sort(), paths.sort());
  for (const path of paths) assert.ok(Buffer.from(archive[path]).equals(await readFile(join(folder, path))), `${path} differs`);
  assert.ok(paths.length > 100, `${paths.length} files`);
  // The smallest distance between two parts that `lizard fit` prints.
  const { stdout } = await runLizard('fit', '--robot', join(ROOT, 'robot.toml'));
  const smallestMm = /no two parts come closer to each other than ([0-9.]+) mm/.exec(stdout)[1];
  assert.match(await page.locator('#files-message').innerText(), new RegExp(`^${paths.length} files. No two parts come closer to each other than ${smallestMm} mm`));
});

testPage('the page saves nothing if making the files is stopped', openStanding, async (page) => {
  let downloadCount = 0;
  page.on('download', () => (downloadCount += 1));
  await unfold(page, '#parts');
  // Stops from within the page, because in a slow browser the work might have ended before the test stops it.
  await page.evaluate(() => {
    const box = document.querySelector('#files-message');
    const observer = new MutationObserver(() => {
      if (!box.textContent.startsWith('Proving that no two parts collide')) return;
      observer.disconnect();
      document.querySelector('#parts-save').click();
    });
    observer.observe(box, { childList: true });
  });
  await page.getByRole('button', { name: 'Download all files' }).click();
  await page.getByText('Stopped; nothing was saved.').waitFor();
  assert.equal(await page.locator('#parts-save').innerText(), 'Download all files');
  assert.equal(downloadCount, 0);
});

testPage('a clicked part shows its name and its file', openParts, async (page) => {
  await lookFromAbove(page);
  assert.match(await clickAt(page, 0.5, 0.5), /^board: board, bought; mounted in step 3\.$/);
  assert.equal(await page.locator('#part option:checked').innerText(), 'board');
  assert.match(await clickAt(page, 0.02, 0.98), /^Click a part/);
  // The list, for the keyboard, has all parts.
  await page.locator('#part').selectOption({ label: 'link A1' });
  const [, file] = /stl\/(.*)\.stl/.exec(await findMessage(page).innerText());
  assert.ok((await readdir(join(folder, 'stl'))).includes(`${file}.stl`), file);
});

testPage('the page leads through the guide step by step', openParts, async (page) => {
  const guide = await readFile(join(folder, 'guide/guide.md'), 'utf8');
  const titles = [...guide.matchAll(/^## ([0-9]+)\. (.*)$/gm)];
  assert.equal(titles.length, 15);
  for (const [, number, title] of titles) {
    await page.getByRole('button', { name: 'Next step' }).click();
    assert.equal(await page.locator('#step-title').innerText(), `${number} of 15: ${title}`);
  }
  assert.ok(await page.getByRole('button', { name: 'Next step' }).isDisabled());
  await page.getByRole('button', { name: 'Whole robot' }).click();
  await lookFromAbove(page);
  assert.match(await clickAt(page, 0.5, 0.5), /^board:/);
  // In the first step there is no board yet, so the parts below it are visible.
  await page.getByRole('button', { name: 'Next step' }).click();
  assert.doesNotMatch(await clickAt(page, 0.5, 0.5), /^board:/);
});

testPage('the parts move with the robot', openParts, async (page) => {
  await lookFromAbove(page);
  // Finds the centre of the pixels that show the head's plate. Seen from above, the robot's head is up and to the left.
  const findHead = () =>
    page.evaluate(() => {
      const canvas = document.querySelector('#canvas-3d');
      const { left, top, width, height } = canvas.getBoundingClientRect();
      const hits = [];
      for (let x = 0.15 * width; x < 0.5 * width; x += 0.025 * width) {
        for (let y = 0.02 * height; y < 0.5 * height; y += 0.025 * width) {
          for (const type of ['pointerdown', 'pointerup']) {
            canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: left + x, clientY: top + y, bubbles: true }));
          }
          if (document.querySelector('#parts-message').textContent.startsWith('head plate')) hits.push([x, y]);
        }
      }
      return [0, 1].map((axis) => hits.reduce((sum, point) => sum + point[axis], 0) / hits.length);
    });
  const isNear = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) < 0.5;
  /** Waits until the head has moved away from `previousPlace` and has stopped; returns its place. */
  const waitForHead = async (previousPlace = [NaN, NaN]) => {
    await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
    for (let lastPlace = previousPlace; ; ) {
      const place = await findHead();
      if (isNear(place, lastPlace) && !isNear(place, previousPlace)) return place;
      lastPlace = place;
      await page.waitForTimeout(1000);
    }
  };
  const straightPlace = await waitForHead();
  await sendLine(page, 'pose 150.59 53.41 318.59 221.41', 'ok pose');
  await advance(page, 1500);
  const bentPlace = await waitForHead(straightPlace);
  // Both cranks turn to the robot's left, which is down and to the left of the picture.
  const sideways = (straightPlace[0] - bentPlace[0] + bentPlace[1] - straightPlace[1]) / Math.SQRT2;
  assert.ok(sideways > 15, `${straightPlace} to ${bentPlace}`);
});

testPage('the page gives the reason why a robot cannot be built', openParts, async (page) => {
  const lowPartsToml = '\n[parts]\nheight = 10.0\n';
  assert.equal(await page.evaluate((lowPartsToml) => window.lizard.robot.change(window.lizard.robot.toml + lowPartsToml), lowPartsToml), null);
  await page.getByText(/Cannot make the parts of this robot: parts\.height must be at least .* but is 10 mm/).waitFor();
});

testPage('3D rendering takes less than a core on a machine without a graphics chip', openParts, async (page, t) => {
  const browserSession = await withTimeout('the processes', page.context().browser().newBrowserCDPSession());
  const readGpuSeconds = async () => {
    const { processInfo } = await withTimeout('the processes', browserSession.send('SystemInfo.getProcessInfo'));
    return processInfo.find(({ type }) => type === 'GPU').cpuTime;
  };
  const measureCoreFraction = async () => {
    const [startMs, startSeconds] = [performance.now(), await readGpuSeconds()];
    await page.waitForTimeout(4000);
    return (1000 * ((await readGpuSeconds()) - startSeconds)) / (performance.now() - startMs);
  };
  await sendLine(page, 'walk', 'ok walk');
  await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
  const shownFraction = await measureCoreFraction();
  await page.locator('#parts').evaluate((panel) => (panel.open = false));
  const hiddenFraction = await measureCoreFraction();
  t.diagnostic(`${(100 * (shownFraction - hiddenFraction)).toFixed(0)} % of a core`);
  assert.ok(shownFraction - hiddenFraction < 0.8, `fraction of a core: ${shownFraction} with the robot in 3D, ${hiddenFraction} without`);
});
