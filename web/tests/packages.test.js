// While another program installs packages, `make web` waits for it, but not forever.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { chmod, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

const SCRIPT = new URL('../../scripts/packages.sh', import.meta.url).pathname;

/** Runs scripts/packages.sh with an apt-get that fails with a message a number of times. */
async function runUpdates(failures, message, waitSeconds) {
  const folder = await mkdtemp(join(tmpdir(), 'lizard-apt-'));
  try {
    const apt = `#!/bin/sh\nn=$(cat ${folder}/n)\necho $((n + 1)) > ${folder}/n\n[ $n -lt ${failures} ] || exit 0\necho '${message}'\nexit 100\n`;
    await writeFile(join(folder, 'n'), '0\n');
    await writeFile(join(folder, 'apt-get'), apt);
    await chmod(join(folder, 'apt-get'), 0o755);
    const { status, stdout } = spawnSync('bash', ['-c', `set -euo pipefail; . ${SCRIPT}; as_root() { "$@"; }; update_lists`], {
      env: { ...process.env, PATH: `${folder}:${process.env.PATH}`, LOCK_WAIT: String(waitSeconds) },
      encoding: 'utf8',
      timeout: 60_000,
    });
    return { status, stdout, tries: Number(await readFile(join(folder, 'n'), 'utf8')) };
  } finally {
    await rm(folder, { recursive: true });
  }
}

const LOCK_MESSAGE = 'E: Could not get lock /var/lib/apt/lists/lock. It is held by process 4711 (apt-get)';

test('a lock that is held is waited for', async () => {
  const { status, stdout, tries } = await runUpdates(2, LOCK_MESSAGE, 60);
  assert.equal(status, 0, stdout);
  assert.equal(tries, 3);
  assert.match(stdout, /^setup: another program installs packages; waiting for it, up to 60 s$/m);
});

test('waiting for a lock ends after the given time', async () => {
  const { status, stdout, tries } = await runUpdates(1000, LOCK_MESSAGE, 3);
  assert.notEqual(status, 0);
  assert.match(stdout, /held by process 4711/);
  assert.ok(tries <= 4, `${tries}`);
});

test('another problem is reported at once', async () => {
  const { status, stdout, tries } = await runUpdates(1000, 'E: The repository has no Release file.', 60);
  assert.notEqual(status, 0);
  assert.match(stdout, /no Release file/);
  assert.equal(tries, 1);
});
