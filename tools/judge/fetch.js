// Installs the packages of a folder's package-lock.json in its node_modules, as `npm ci --ignore-scripts` does:
// node fetch.js [FOLDER]; the default is the judge's folder. Debian's Node comes without npm, and Debian's package of
// npm needs 390 other packages, while `make test` needs one. A package that is installed in the right version stays.
// Packages for other kinds of machine are left out.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, normalize, resolve } from 'node:path';
import { gunzipSync } from 'node:zlib';

const judgeFolder = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const projectFolder = process.argv[2] ? resolve(process.argv[2]) : judgeFolder;

/** Returns the version of the package in a folder; undefined if there is none. */
function installedVersion(folder) {
  try {
    return JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')).version;
  } catch {
    return undefined;
  }
}

/** Yields the files of a tar archive, `{ name, bytes, mode }`; folders and links are left out. */
function* readTar(tar) {
  const text = (start, length) => tar.toString('utf8', start, start + length).replace(/\0.*$/s, '');
  for (let offset = 0; offset + 512 <= tar.length && tar[offset] !== 0; ) {
    const size = parseInt(text(offset + 124, 12), 8);
    const prefix = text(offset + 345, 155);
    const name = (prefix ? `${prefix}/` : '') + text(offset, 100);
    const isFile = tar[offset + 156] === 0 || tar[offset + 156] === 0x30;
    const mode = parseInt(text(offset + 100, 8), 8) | 0o644;
    if (isFile) yield { name, mode, bytes: tar.subarray(offset + 512, offset + 512 + size) };
    offset += 512 + Math.ceil(size / 512) * 512;
  }
}

/** True if a package with these systems, processors and C libraries runs on this machine. */
function isForThisMachine({ os, cpu, libc }) {
  const hasGlibc = process.report.getReport().header.glibcVersionRuntime !== undefined;
  const allows = (list, value) => !list || [list].flat().includes(value);
  return allows(os, process.platform) && allows(cpu, process.arch) && allows(libc, hasGlibc ? 'glibc' : 'musl');
}

/** Returns a package's address in the registry, for a lock file without addresses. */
function registryUrl(path, version) {
  const name = path.replace(/^.*node_modules\//, '');
  return `https://registry.npmjs.org/${name}/-/${name.replace(/^.*\//, '')}-${version}.tgz`;
}

/** Downloads an address; tries again after a failure. */
async function download(url, triesLeft = 4) {
  try {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url} answers ${response.status}`);
    return Buffer.from(await response.arrayBuffer());
  } catch (error) {
    if (triesLeft === 1) throw error;
    return download(url, triesLeft - 1);
  }
}

async function install(path, entry) {
  const { version, integrity } = entry;
  const folder = join(projectFolder, path);
  if (installedVersion(folder) === version || !isForThisMachine(entry)) return;
  const url = entry.resolved ?? registryUrl(path, version);
  const archive = await download(url);
  const checksum = `sha512-${createHash('sha512').update(archive).digest('base64')}`;
  if (checksum !== integrity) throw new Error(`${url} differs from package-lock.json: ${checksum}`);
  const newFolder = `${folder}.new`;
  rmSync(newFolder, { recursive: true, force: true });
  for (const { name, bytes, mode } of readTar(gunzipSync(archive))) {
    // All files of an archive are in one folder, `package`.
    const file = join(newFolder, normalize(`/${name}`).replace(/^\/[^/]+\//, ''));
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, bytes, { mode });
  }
  rmSync(folder, { recursive: true, force: true });
  renameSync(newFolder, folder);
  console.log(`setup: ${path} ${version}`);
}

try {
  const { packages } = JSON.parse(readFileSync(join(projectFolder, 'package-lock.json'), 'utf8'));
  // Several at a time, since most packages are small.
  const queue = Object.entries(packages).filter(([path]) => path !== '');
  const installQueued = async () => {
    for (let next = queue.shift(); next; next = queue.shift()) await install(...next);
  };
  await Promise.all([installQueued(), installQueued(), installQueued(), installQueued()]);
} catch (error) {
  const reason = error.cause?.message ?? error.message;
  console.error(`setup: the packages of ${projectFolder} cannot be fetched: ${reason}`);
  console.error('setup: behind a proxy, run `npm ci --ignore-scripts` in that folder instead');
  process.exitCode = 1;
}
