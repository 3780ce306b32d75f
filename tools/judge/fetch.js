// Loads the packages of a folder's package-lock.json into its node_modules, as `npm ci --ignore-scripts` does:
// node fetch.js [FOLDER], the judge's by default. Debian's Node comes without npm, whose package brings 390
// others for the one that `make test` needs. Packages that are present in the right version stay.
// Packages for other machines than this one are left out.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, normalize, resolve } from 'node:path';
import { gunzipSync } from 'node:zlib';

const judge = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const here = process.argv[2] ? resolve(process.argv[2]) : judge;

/** Returns the version that is installed in a folder, if any. */
function installed(folder) {
  try {
    return JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')).version;
  } catch {
    return undefined;
  }
}

/** Yields the files of a tar archive, `{ name, bytes, mode }`; folders and links are left out. */
function* files(tar) {
  const text = (from, length) => tar.toString('utf8', from, from + length).replace(/\0.*$/s, '');
  for (let at = 0; at + 512 <= tar.length && tar[at] !== 0; ) {
    const size = parseInt(text(at + 124, 12), 8);
    const prefix = text(at + 345, 155);
    const name = (prefix ? `${prefix}/` : '') + text(at, 100);
    const isFile = tar[at + 156] === 0 || tar[at + 156] === 0x30;
    const mode = parseInt(text(at + 100, 8), 8) | 0o644;
    if (isFile) yield { name, mode, bytes: tar.subarray(at + 512, at + 512 + size) };
    at += 512 + Math.ceil(size / 512) * 512;
  }
}

/** True for a package that this machine can use. */
function suits({ os, cpu, libc }) {
  const glibc = process.report.getReport().header.glibcVersionRuntime !== undefined;
  const among = (list, mine) => !list || [list].flat().includes(mine);
  return among(os, process.platform) && among(cpu, process.arch) && among(libc, glibc ? 'glibc' : 'musl');
}

/** Returns a package's address in the registry, for lock files that leave it out. */
function address(path, version) {
  const name = path.replace(/^.*node_modules\//, '');
  return `https://registry.npmjs.org/${name}/-/${name.replace(/^.*\//, '')}-${version}.tgz`;
}

/** Downloads an address. A broken connection is tried again. */
async function download(from, tries = 4) {
  try {
    const response = await fetch(from);
    if (!response.ok) throw new Error(`${from} answers ${response.status}`);
    return Buffer.from(await response.arrayBuffer());
  } catch (error) {
    if (tries === 1) throw error;
    return download(from, tries - 1);
  }
}

async function load(path, entry) {
  const { version, integrity } = entry;
  const folder = join(here, path);
  if (installed(folder) === version || !suits(entry)) return;
  const resolved = entry.resolved ?? address(path, version);
  const archive = await download(resolved);
  const sum = `sha512-${createHash('sha512').update(archive).digest('base64')}`;
  if (sum !== integrity) throw new Error(`${resolved} is not what package-lock.json says: ${sum}`);
  const fresh = `${folder}.new`;
  rmSync(fresh, { recursive: true, force: true });
  for (const { name, bytes, mode } of files(gunzipSync(archive))) {
    // An archive's files are all in one folder, `package`.
    const file = join(fresh, normalize(`/${name}`).replace(/^\/[^/]+\//, ''));
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, bytes, { mode });
  }
  rmSync(folder, { recursive: true, force: true });
  renameSync(fresh, folder);
  console.log(`setup: ${path} ${version}`);
}

try {
  const { packages } = JSON.parse(readFileSync(join(here, 'package-lock.json'), 'utf8'));
  // A few at a time: most are small.
  const queue = Object.entries(packages).filter(([path]) => path !== '');
  const worker = async () => {
    for (let next = queue.shift(); next; next = queue.shift()) await load(...next);
  };
  await Promise.all([worker(), worker(), worker(), worker()]);
} catch (error) {
  const why = error.cause?.message ?? error.message;
  console.error(`setup: the packages of ${here} cannot be fetched: ${why}`);
  console.error('setup: behind a proxy, run `npm ci --ignore-scripts` in that folder instead');
  process.exitCode = 1;
}
