// The book, opened from a file: the search finds a word.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { before } from 'node:test';

import { openBlankPage, useBrowser, testPage } from './browser.js';
import { makeFolder } from './temporary-folder.js';

const folder = await makeFolder();

useBrowser();
before(() => {
  const build = spawnSync('mkdocs', ['build', '--strict', '--quiet', '--site-dir', folder], { cwd: new URL('../..', import.meta.url), encoding: 'utf8' });
  assert.equal(build.status, 0, build.stderr);
});

testPage('the book\'s search finds a word without a server', openBlankPage, async (book) => {
  await book.goto(`file://${folder}/index.html`);
  // The theme reads the input on key-up only, so the text is typed, not set.
  await book.locator('input[name=query]').pressSequentially('brownout');
  const firstResult = book.locator('.md-search-result__link').first();
  await firstResult.waitFor();
  assert.match(await firstResult.getAttribute('href'), /^file:.*(faults|firmware|quickstart|console)\.html/);
});
