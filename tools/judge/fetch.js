// Installs the packages in a folder's package-lock.json, as `npm ci --ignore-scripts` does: node fetch.js [FOLDER].
// The default folder is the judge's. Debian's Node comes without npm, and Debian's npm package needs 390 other
// packages, while `make test` needs one. A package that is already installed in the right version is kept.
// Packages for other platforms are skipped.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, normalize, resolve } from 'node:path';
import { gunzipSync } from 'node:zlib';

const judgeFolder = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const projectFolder = process.argv[2] ? resolve(process.argv[2]) : judgeFolder;

/** Returns the version of the package in a folder; undefined if there is none. */
function readInstalledVersion(folder) {
  try {
    return JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')).version;
  } catch {
    return undefined;
  }
}

/** Yields each file of a tar archive as `{ name, bytes, mode }`; skips folders and links. */
function* readTar(tar) {
  const readText = (start, length) => tar.toString('utf8', start, start + length).replace(/\0.*$/s, '');
  for (let offset = 0; offset + 512 <= tar.length && tar[offset] !== 0; ) {
    const size = parseInt(readText(offset + 124, 12), 8);
    const prefix = readText(offset + 345, 155);
    const name = (prefix ? `${prefix}/` : '') + readText(offset, 100);
    const isFile = tar[offset + 156] === 0 || tar[offset + 156] === 0x30;
    const mode = parseInt(readText(offset + 100, 8), 8) | 0o644;
    if (isFile) yield { name, mode, bytes: tar.subarray(offset + 512, offset + 512 + size) };
    offset += 512 + Math.ceil(size / 512) * 512;
  }
}

/** Returns true if a package for these operating systems, processors and C libraries runs on this machine. */
function supportsThisMachine({ os, cpu, libc }) {
  const hasGlibc = process.report.getReport().header.glibcVersionRuntime !== undefined;
  const allows = (list, value) => !list || [list].flat().includes(value);
  return allows(os, process.platform) && allows(cpu, process.arch) && allows(libc, hasGlibc ? 'glibc' : 'musl');
}

/** Returns a package's URL in the registry, for a lock file without URLs. */
function makeRegistryUrl(path, version) {
  const name = path.replace(/^.*node_modules\//, '');
  return `https://registry.npmjs.org/${name}/-/${name.replace(/^.*\//, '')}-${version}.tgz`;
}

/** Downloads a URL; tries up to four times. */
async function download(url, attemptsLeft = 4) {
  try {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url} returned status ${response.status}`);
    return Buffer.from(await response.arrayBuffer());
  } catch (error) {
    if (attemptsLeft === 1) throw error;
    return download(url, attemptsLeft - 1);
  }
}

async function install(path, entry) {
  const { version, integrity } = entry;
  const folder = join(projectFolder, path);
  if (readInstalledVersion(folder) === version || !supportsThisMachine(entry)) return;
  const url = entry.resolved ?? makeRegistryUrl(path, version);
  const archive = await download(url);
  const checksum = `sha512-${createHash('sha512').update(archive).digest('base64')}`;
  if (checksum !== integrity) throw new Error(`${url} has checksum ${checksum}, expected ${integrity}`);
  // Two processes may install the same package at the same time, because .ci/run runs targets in parallel. The name
  // begins with a dot, so that a pattern such as node-linux-* does not match it.
  const newFolder = join(dirname(folder), `.${basename(folder)}.${process.pid}`);
  rmSync(newFolder, { recursive: true, force: true });
  for (const { name, bytes, mode } of readTar(gunzipSync(archive))) {
    // All files of an archive are in one top folder, usually `package`.
    const file = join(newFolder, normalize(`/${name}`).replace(/^\/[^/]+\//, ''));
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, bytes, { mode });
  }
  try {
    renameSync(newFolder, folder);
  } catch {
    // Usually the folder exists: it has another version, or another process has just installed this version.
    if (readInstalledVersion(folder) !== version) {
      rmSync(folder, { recursive: true, force: true });
      try {
        renameSync(newFolder, folder);
      } catch (error) {
        if (readInstalledVersion(folder) !== version) throw error;
      }
    }
  } finally {
    rmSync(newFolder, { recursive: true, force: true });
  }
  console.log(`setup: ${path} ${version}`);
}

try {
  const { packages } = JSON.parse(readFileSync(join(projectFolder, 'package-lock.json'), 'utf8'));
  // Four downloads run at a time, because a small package takes more time to wait for than to transfer.
  const queue = Object.entries(packages).filter(([path]) => path !== '');
  const installQueued = async () => {
    for (let next = queue.shift(); next; next = queue.shift()) await install(...next);
  };
  await Promise.all([installQueued(), installQueued(), installQueued(), installQueued()]);
} catch (error) {
  const reason = error.cause?.message ?? error.message;
  console.error(`setup: cannot fetch the packages of ${projectFolder}: ${reason}`);
  console.error('setup: behind a proxy, run `npm ci --ignore-scripts` in that folder instead');
  process.exitCode = 1;
}
