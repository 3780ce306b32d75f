// Loads the packages of package-lock.json into node_modules, as `npm ci` does, where there is no npm.
// What is there in the right version stays.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';
import { gunzipSync } from 'node:zlib';

const here = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);

/** The version that is installed in a folder, if any. */
function installed(folder) {
  try {
    return JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')).version;
  } catch {
    return undefined;
  }
}

/** The files of a tar archive, `{ name, bytes }`; what is no file is left out. */
function* files(tar) {
  const text = (from, length) => tar.toString('utf8', from, from + length).replace(/\0.*$/s, '');
  for (let at = 0; at + 512 <= tar.length && tar[at] !== 0; ) {
    const size = parseInt(text(at + 124, 12), 8);
    const prefix = text(at + 345, 155);
    const name = (prefix ? `${prefix}/` : '') + text(at, 100);
    const isFile = tar[at + 156] === 0 || tar[at + 156] === 0x30;
    if (isFile) yield { name, bytes: tar.subarray(at + 512, at + 512 + size) };
    at += 512 + Math.ceil(size / 512) * 512;
  }
}

async function load(path, { version, resolved, integrity }) {
  const folder = join(here, path);
  if (installed(folder) === version) return;
  const response = await fetch(resolved);
  if (!response.ok) throw new Error(`${resolved} answers ${response.status}`);
  const archive = Buffer.from(await response.arrayBuffer());
  const sum = `sha512-${createHash('sha512').update(archive).digest('base64')}`;
  if (sum !== integrity) throw new Error(`${resolved} is not what package-lock.json says: ${sum}`);
  const fresh = `${folder}.new`;
  rmSync(fresh, { recursive: true, force: true });
  for (const { name, bytes } of files(gunzipSync(archive))) {
    // An archive's files are all in one folder, `package`.
    const file = join(fresh, normalize(`/${name}`).replace(/^\/[^/]+\//, ''));
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, bytes);
  }
  rmSync(folder, { recursive: true, force: true });
  renameSync(fresh, folder);
  console.log(`setup: ${path} ${version}`);
}

try {
  const { packages } = JSON.parse(readFileSync(join(here, 'package-lock.json'), 'utf8'));
  for (const [path, entry] of Object.entries(packages)) if (path !== '') await load(path, entry);
} catch (error) {
  const why = error.cause?.message ?? error.message;
  console.error(`setup: the judge's packages cannot be fetched: ${why}`);
  console.error('setup: behind a proxy, run `npm ci` in the folder judge instead');
  process.exitCode = 1;
}
