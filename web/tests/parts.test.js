// The parts in the page are those of `lizard parts`: the same files, the same steps, at the robot's own pose. They are not loaded
// before their panel is opened.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { promisify } from 'node:util';
import { gzipSync } from 'node:zlib';

import { unzipSync } from 'fflate';

import { advance, openBlank, address, close, complaints, open, openStanding, closePages, type, unfold, within } from './browser.js';

const ROOT = new URL('../../', import.meta.url).pathname;
/** Limit of the page's first load, compressed, bytes. */
const FIRST_LOAD = 500_000;

let folder;

before(open);
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'parts-'));
  const made = promisify(execFile)(resolve(ROOT, process.env.LIZARD), ['parts', folder, '--robot', join(ROOT, 'robot.toml')]);
  await within('lizard parts', made);
});
afterEach(closePages);
after(async () => {
  await rm(folder, { recursive: true, force: true });
  await close();
});

const message = (page) => page.locator('#parts-said');

async function openParts(options) {
  const page = await openStanding(options);
  await unfold(page, '#parts');
  await page.getByText('Click a part for its name').waitFor();
  await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
  return page;
}

/** Clicks on the picture, at a share of its width and height; returns the message. */
async function clickAt(page, across, down) {
  const { x, y, width, height } = await page.locator('#space').boundingBox();
  await page.mouse.click(x + across * width, y + down * height);
  return message(page).innerText();
}

/** Turns the view to straight above. */
async function lookFromAbove(page) {
  for (let n = 0; n < 12; n++) await page.locator('#space').press('ArrowUp');
}

test('lengths that cannot be printed are reported at once, with the nearest that can, as by the program', async () => {
  const page = await openStanding();
  await unfold(page, '#lengths-panel');
  const length = page.locator('#lengths input[name="leg.crank"]');
  await length.fill('46');
  await length.press('Enter');
  await page.locator('#fit-said', { hasText: /^The parts fit: no two come nearer than \d\.\d\d mm\.$/ }).waitFor();
  await length.fill('52');
  await length.press('Enter');
  await page.locator('#fit-said', { hasText: /^These lengths cannot be printed: .* would overlap by [\d.]+ mm\.$/ }).waitFor();
  const use = page.locator('#fit-use');
  await use.waitFor();
  const nearest = Number(/ ([\d.]+)$/.exec(await use.innerText())[1]);
  assert.ok(nearest > 46 && nearest < 52, `${nearest} mm`);

  const tried = await mkdtemp(join(tmpdir(), 'tried-'));
  after(() => rm(tried, { recursive: true, force: true }));
  const parts = async (mm) => {
    const path = join(tried, 'robot.toml');
    const toml = await page.evaluate((mm) => {
      const { robot, toml } = window.lizard;
      return robot.constructor.lengths(toml, [['leg.crank', mm], ['leg.follower', mm]], false).text;
    }, mm);
    await writeFile(path, toml);
    const made = promisify(execFile)(resolve(ROOT, process.env.LIZARD), ['parts', join(tried, 'parts'), '--robot', path]);
    return within('lizard parts', made.then(() => 'made', ({ stderr }) => stderr));
  };
  assert.equal(await parts(nearest), 'made');
  assert.match(await parts(nearest + 0.5), /overlap|may come as near as/);

  await use.click();
  await page.locator('#fit-said', { hasText: /^The parts fit/ }).waitFor();
  assert.equal(await length.inputValue(), String(nearest));
  assert.equal(await use.isHidden(), true);

  // The slider marks the longest that can be printed at the same value.
  const printed = page.locator('#length-printed', { hasText: /^Can be printed from [\d.]+ to [\d.]+ mm\.$/ });
  await printed.waitFor();
  const [, least, most] = /from ([\d.]+) to ([\d.]+) mm/.exec(await printed.innerText());
  assert.equal(Number(most), nearest);
  assert.equal(await parts(Number(least)), 'made');
  const { ends, marks } = await page.locator('#length-slide').evaluate((slide) => {
    const { style } = document.querySelector('#length-marks');
    return { ends: [Number(slide.min), Number(slide.max)], marks: ['--from', '--to'].map((name) => Number.parseFloat(style.getPropertyValue(name))) };
  });
  const at = (share) => ends[0] + ((ends[1] - ends[0]) * share) / 100;
  assert.deepEqual(marks.map(at).map((mm) => Math.round(mm * 100) / 100), [Number(least), nearest]);
  assert.ok(ends[0] <= Number(least) && ends[1] > nearest, `${ends} of what walks`);
});

test('while a length is dragged, the two parts that meet are red in 3D, with their millimetres', async () => {
  const page = await openStanding();
  await unfold(page, '#lengths-panel');
  await page.locator('#solid').click();
  await page.getByText('Click a part for its name').waitFor();
  const slide = page.locator('#length-slide');
  await slide.focus();
  await page.waitForFunction(() => Number(document.querySelector('#length-slide').max) > 52);
  const reds = async () => {
    const picture = (await page.locator('#space').screenshot()).toString('base64');
    return page.evaluate(async (picture) => {
      const bytes = Uint8Array.from(atob(picture), (letter) => letter.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
      pen.drawImage(image, 0, 0);
      const { data } = pen.getImageData(0, 0, image.width, image.height);
      let red = 0;
      for (let n = 0; n < data.length; n += 4) {
        const [r, g, b] = data.subarray(n, n + 3);
        // The orange of a leg has more green.
        if (r > 90 && r > 3 * g && r > 3 * b) red += 1;
      }
      return red;
    }, picture);
  };
  const atRest = await reds();
  const before = await page.evaluate(() => window.lizard.toml);
  const drag = (mm) => slide.evaluate((slide, mm) => ((slide.value = String(mm)), slide.dispatchEvent(new Event('input'))), mm);
  await drag(52);
  const said = page.locator('#fit-said', { hasText: /^These lengths cannot be printed: .* would overlap by [\d.]+ mm\.$/ });
  await said.waitFor();
  const [, pair, mm] = /printed: (.*) would overlap by ([\d.]+) mm/.exec(await said.innerText());
  await page.locator('#parts-said', { hasText: `${pair}: ${mm} mm too much.` }).waitFor();
  assert.equal(await page.evaluate(() => window.lizard.toml), before, 'it is not let go');
  // The stop button is red, too. The picture follows within a moment.
  const paints = async (isRed) => {
    while ((await reds()) > atRest + 50 !== isRed) await page.waitForTimeout(200);
  };
  await within('red parts', paints(true));
  // At the old length the parts fit again.
  await drag(45);
  await page.locator('#fit-said', { hasText: /^The parts fit/ }).waitFor();
  await within('no red parts', paints(false));
});

test('the files that a changed length affects are listed, and can be downloaded alone', async () => {
  const page = await openStanding();
  await unfold(page, '#parts');
  assert.ok(await page.locator('#parts-changed').isHidden(), 'nothing is changed');
  assert.equal(await page.evaluate(() => window.lizard.change(window.lizard.robot.constructor.lengths(window.lizard.toml, [['leg.crank', 46], ['leg.follower', 46]], false).text)), null);
  const download = page.waitForEvent('download');
  await page.locator('#parts-changed').click();
  const saved = await download;
  assert.equal(saved.suggestedFilename(), 'robot-changed-parts.zip');
  const archive = unzipSync(await readFile(await saved.path()));
  const changed = await mkdtemp(join(tmpdir(), 'changed-'));
  after(() => rm(changed, { recursive: true, force: true }));
  const path = join(changed, 'robot.toml');
  await writeFile(path, await page.evaluate(() => window.lizard.toml));
  await within('lizard parts', promisify(execFile)(resolve(ROOT, process.env.LIZARD), ['parts', join(changed, 'parts'), '--robot', path]));
  const entries = await readdir(join(changed, 'parts'), { recursive: true, withFileTypes: true });
  const paths = entries.filter((entry) => entry.isFile()).map(({ parentPath, name }) => join(parentPath, name).slice(join(changed, 'parts').length + 1));
  const same = async (name) => {
    const [one, other] = await Promise.all([join(changed, 'parts', name), join(folder, name)].map((file) => readFile(file).catch(() => Buffer.alloc(0))));
    return one.equals(other);
  };
  const differ = [];
  for (const name of paths) if (!(await same(name))) differ.push(name);
  assert.deepEqual(Object.keys(archive).sort(), differ.sort());
  assert.ok(differ.length > 5 && differ.length < paths.length - 20, `${differ.length} of ${paths.length}`);
  assert.deepEqual((await page.locator('#files-list li').allInnerTexts()).sort(), differ.sort());
  assert.match(await page.locator('#files-said').innerText(), new RegExp(`^${differ.length} of ${paths.length} files are not those of robot\\.toml:`));
});

test('opening the page loads no parts, and less than half a megabyte', async () => {
  const page = await openBlank();
  const loaded = new Map();
  page.on('response', (response) => loaded.set(response.url().replace(address(), ''), response.body()));
  await page.goto(address());
  await page.waitForFunction(() => window.lizard);
  const names = [...loaded.keys()];
  const sizes = await within('all bodies', Promise.all([...loaded.values()].map(async (body) => gzipSync(await body).length)));
  const sum = sizes.reduce((a, b) => a + b, 0);
  assert.ok(names.includes('files/lizard.wasm'), names.join(' '));
  assert.ok(sum < FIRST_LOAD, `${sum} bytes`);
  const early = names.filter((name) => /parts\.wasm|tune\.wasm|space|workshop|worker-.*parts/.test(name));
  assert.deepEqual(early, []);
  await unfold(page, '#parts');
  await page.getByText('Click a part for its name').waitFor();
  assert.ok(loaded.has('files/parts.wasm') && [...loaded.keys()].some((name) => name.includes('space')));
});

test('the archive has the files of lizard parts, byte for byte', async () => {
  const page = await openStanding();
  await unfold(page, '#parts');
  const download = page.waitForEvent('download');
  // Every message is recorded when it appears; polling a busy browser would miss some.
  await page.evaluate(() => {
    const box = document.querySelector('#files-said');
    window.said = [];
    new MutationObserver(() => window.said.push(box.textContent)).observe(box, { childList: true });
  });
  await page.getByRole('button', { name: 'Download all files' }).click();
  const saved = await download;
  const progress = await page.evaluate(() => window.said);
  assert.ok(progress.some((text) => /^Proving that no two parts meet: [0-9]+ of [0-9]+\.$/.test(text)), progress.join(' '));
  assert.equal(saved.suggestedFilename(), 'robot-parts.zip');
  const archive = unzipSync(await readFile(await saved.path()));
  const entries = await readdir(folder, { recursive: true, withFileTypes: true });
  const paths = entries.filter((entry) => entry.isFile()).map(({ parentPath, name }) => join(parentPath, name).slice(folder.length + 1));
  assert.deepEqual(Object.keys(archive).sort(), paths.sort());
  for (const path of paths) assert.ok(Buffer.from(archive[path]).equals(await readFile(join(folder, path))), `${path} differs`);
  assert.ok(paths.length > 100, `${paths.length} files`);
  // The nearest two parts, as `lizard fit` prints them.
  const { stdout } = await within('lizard fit', promisify(execFile)(resolve(ROOT, process.env.LIZARD), ['fit', '--robot', join(ROOT, 'robot.toml')]));
  const least = /no two parts come nearer than ([0-9.]+) mm/.exec(stdout)[1];
  assert.match(await page.locator('#files-said').innerText(), new RegExp(`^${paths.length} files. No two parts come nearer than ${least} mm`));
});

test('making the files can be stopped, and then nothing is saved', async () => {
  const page = await openStanding();
  let downloads = 0;
  page.on('download', () => (downloads += 1));
  await unfold(page, '#parts');
  // At once: in a slow browser the work might have ended before it is stopped.
  await page.evaluate(() => {
    const box = document.querySelector('#files-said');
    const observer = new MutationObserver(() => {
      if (!box.textContent.startsWith('Proving that no two parts meet')) return;
      observer.disconnect();
      document.querySelector('#parts-save').click();
    });
    observer.observe(box, { childList: true });
  });
  await page.getByRole('button', { name: 'Download all files' }).click();
  await page.getByText('Stopped; nothing was saved.').waitFor();
  assert.equal(await page.locator('#parts-save').innerText(), 'Download all files');
  assert.equal(downloads, 0);
});

test('a clicked part shows its name and its file', async () => {
  const page = await openParts();
  await lookFromAbove(page);
  assert.match(await clickAt(page, 0.5, 0.5), /^board: board, bought; put on in step 3\.$/);
  assert.equal(await page.locator('#part option:checked').innerText(), 'board');
  assert.match(await clickAt(page, 0.02, 0.98), /^Click a part/);
  // By keyboard: the list names all parts.
  await page.locator('#part').selectOption({ label: 'link A1' });
  const [, file] = /stl\/(.*)\.stl/.exec(await message(page).innerText());
  assert.ok((await readdir(join(folder, 'stl'))).includes(`${file}.stl`), file);
});

test('the guide is gone through step by step', async () => {
  const page = await openParts();
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

test('the parts go where the robot goes', async () => {
  const page = await openParts();
  await lookFromAbove(page);
  // The centre of the pixels that show the head's plate: seen from above, ahead is to the left and up.
  const look = () =>
    page.evaluate(() => {
      const space = document.querySelector('#space');
      const { left, top, width, height } = space.getBoundingClientRect();
      const seen = [];
      for (let x = 0.15 * width; x < 0.5 * width; x += 0.025 * width) {
        for (let y = 0.02 * height; y < 0.5 * height; y += 0.025 * width) {
          for (const type of ['pointerdown', 'pointerup']) {
            space.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: left + x, clientY: top + y, bubbles: true }));
          }
          if (document.querySelector('#parts-said').textContent.startsWith('head plate')) seen.push([x, y]);
        }
      }
      return [0, 1].map((axis) => seen.reduce((sum, point) => sum + point[axis], 0) / seen.length);
    });
  const alike = (one, other) => Math.hypot(one[0] - other[0], one[1] - other[1]) < 0.5;
  /** Waits until the head has moved away from `was` and stands still; returns its place. */
  const head = async (was = [NaN, NaN]) => {
    await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
    for (let before = was; ; ) {
      const now = await look();
      if (alike(now, before) && !alike(now, was)) return now;
      before = now;
      await page.waitForTimeout(1000);
    }
  };
  const before = await head();
  await type(page, 'pose 150.59 53.41 318.59 221.41', 'ok pose');
  await advance(page, 1500);
  const bent = await head(before);
  // Both cranks turn to the robot's left, which is down and to the left of the picture.
  const aside = (before[0] - bent[0] + bent[1] - before[1]) / Math.SQRT2;
  assert.ok(aside > 15, `${before} to ${bent}`);
});

test('a robot that cannot be built says why', async () => {
  const page = await openParts();
  const low = '\n[parts]\nheight = 10.0\n';
  assert.equal(await page.evaluate((low) => window.lizard.change(window.lizard.toml + low), low), null);
  await page.getByText('There are no parts of this robot: parts.height is 10 mm').waitFor();
});

test('3D pictures leave the processor time on a machine without a graphics chip', async (t) => {
  const page = await openParts();
  const browser = await within('the processes', page.context().browser().newBrowserCDPSession());
  const used = async () => {
    const { processInfo } = await within('the processes', browser.send('SystemInfo.getProcessInfo'));
    return processInfo.find(({ type }) => type === 'GPU').cpuTime;
  };
  const share = async () => {
    const [begun, before] = [performance.now(), await used()];
    await page.waitForTimeout(4000);
    return (1000 * ((await used()) - before)) / (performance.now() - begun);
  };
  await type(page, 'walk', 'ok walk');
  await page.locator('#parts').evaluate((panel) => panel.scrollIntoView());
  const shown = await share();
  await page.locator('#parts').evaluate((panel) => (panel.open = false));
  const hidden = await share();
  t.diagnostic(`${(100 * (shown - hidden)).toFixed(0)} % of a core`);
  assert.ok(shown - hidden < 0.8, `${shown} of a core with the robot in space, ${hidden} without`);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
