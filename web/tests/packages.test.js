// `make web` waits while another program installs packages, but only for a limited time.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { test } from 'node:test';

import { makeFolder } from './temporary-folder.js';

const SCRIPT = new URL('../../scripts/packages.sh', import.meta.url).pathname;

/** Runs update_lists of scripts/packages.sh with an apt-get that fails `failureCount` times with a message. */
async function updateLists(failureCount, message, waitSeconds) {
  const folder = await makeFolder();
  const aptScript = `#!/bin/sh\nn=$(cat ${folder}/n)\necho $((n + 1)) > ${folder}/n\n[ $n -lt ${failureCount} ] || exit 0\necho '${message}'\nexit 100\n`;
  await writeFile(join(folder, 'n'), '0\n');
  await writeFile(join(folder, 'apt-get'), aptScript, { mode: 0o755 });
  const { status, stdout } = spawnSync('bash', ['-c', `set -euo pipefail; . ${SCRIPT}; as_root() { "$@"; }; update_lists`], {
    env: { ...process.env, PATH: `${folder}:${process.env.PATH}`, LOCK_WAIT: String(waitSeconds) },
    encoding: 'utf8',
    timeout: 60_000,
  });
  return { status, stdout, attemptCount: Number(await readFile(join(folder, 'n'), 'utf8')) };
}

const LOCK_MESSAGE = 'E: Could not get lock /var/lib/apt/lists/lock. It is held by process 4711 (apt-get)';

test('the update waits while another program holds the lock', async () => {
  const { status, stdout, attemptCount } = await updateLists(2, LOCK_MESSAGE, 60);
  assert.equal(status, 0, stdout);
  assert.equal(attemptCount, 3);
  assert.match(stdout, /^setup: another program is installing packages; waiting up to 60 s$/m);
});

test('the wait for a lock ends after the given time', async () => {
  const { status, stdout, attemptCount } = await updateLists(1000, LOCK_MESSAGE, 3);
  assert.notEqual(status, 0);
  assert.match(stdout, /held by process 4711/);
  assert.ok(attemptCount <= 4, `${attemptCount} attempts`);
});

test('any other problem is reported at once', async () => {
  const { status, stdout, attemptCount } = await updateLists(1000, 'E: The repository has no Release file.', 60);
  assert.notEqual(status, 0);
  assert.match(stdout, /no Release file/);
  assert.equal(attemptCount, 1);
});
