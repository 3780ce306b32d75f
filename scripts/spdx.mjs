// Prints a release's bill of materials as SPDX 2.3 in JSON (https://spdx.github.io/spdx-spec/v2.3/):
//     node scripts/spdx.mjs VERSION COMMIT
// Run it in the root of the built tree. The document describes the programs, the image and the page. Crates come from
// `cargo metadata`, Node's packages from the lock files, libraries from Debian. SOURCE_DATE_EPOCH is the document's
// time.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';

const [version, commit] = process.argv.slice(2);
const epoch = Number(process.env.SOURCE_DATE_EPOCH);
if (!version || !commit || !Number.isInteger(epoch)) {
  console.error('usage: SOURCE_DATE_EPOCH=seconds node scripts/spdx.mjs VERSION COMMIT');
  process.exit(2);
}
const run = (program, ...args) => execFileSync(program, args, { encoding: 'utf8', maxBuffer: 1 << 28 });

/** Packages by SPDXID. A relationship is a line of three words, because a Set recognises equal strings only. */
const packages = new Map();
const relationships = new Set();
const relate = (from, type, to) => relationships.add(`${from} ${type} ${to}`);

/** Adds a package and returns its SPDXID. */
function addPackage(origin, name, versionInfo, license, fields = {}) {
  const SPDXID = `SPDXRef-${origin}-${name}-${versionInfo}`.replace(/[^A-Za-z0-9.-]+/g, '-');
  packages.set(SPDXID, {
    SPDXID, name, versionInfo,
    downloadLocation: 'NOASSERTION', filesAnalyzed: false,
    licenseConcluded: 'NOASSERTION', licenseDeclared: license, copyrightText: 'NOASSERTION',
    ...fields,
  });
  return SPDXID;
}
const purlFields = (locator) => ({ externalRefs: [{ referenceCategory: 'PACKAGE-MANAGER', referenceType: 'purl', referenceLocator: locator }] });

// --- The release's products -------------------------------------------------
const GPL = 'GPL-3.0-or-later';
const addProduct = (name, license, purpose) => {
  const id = addPackage('release', name, version, license, { primaryPackagePurpose: purpose });
  relate('SPDXRef-DOCUMENT', 'DESCRIBES', id);
  return id;
};
const program = addProduct('lizard-program', GPL, 'APPLICATION');
const programWithoutSimulator = addProduct('lizard-program-without-simulator', 'MIT OR Apache-2.0', 'APPLICATION'); // for ARM and for Windows
const image = addProduct('lizard-image', 'MIT OR Apache-2.0', 'FIRMWARE');
const page = addProduct('lizard-page', '(MIT OR Apache-2.0) AND MIT AND GPL-2.0-or-later', 'APPLICATION');

// --- Crates ----------------------------------------------------------------

/** Reads the checksums of a Cargo.lock, by "name version". */
function readChecksums(folder) {
  const checksums = new Map();
  for (const block of readFileSync(`${folder}/Cargo.lock`, 'utf8').split('[[package]]')) {
    const value = (key) => block.match(new RegExp(`^${key} = "(.*)"$`, 'm'))?.[1];
    if (value('checksum')) checksums.set(`${value('name')} ${value('version')}`, value('checksum'));
  }
  return checksums;
}

/**
 * Adds a workspace's crate and all its dependencies to a product. `excluded` are crates that the product does not have:
 * cargo also lists dependencies that only another member of the workspace enables.
 */
function addCrates(folder, rootName, product, excluded, ...cargoArguments) {
  const text = execFileSync('cargo', ['metadata', '--locked', '--format-version', '1', ...cargoArguments], { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });
  const metadata = JSON.parse(text);
  const checksums = readChecksums(folder);
  const cratesById = new Map(metadata.packages.map((entry) => [entry.id, entry]));
  const nodesById = new Map(metadata.resolve.nodes.map((entry) => [entry.id, entry]));
  const spdxIds = new Map();
  const visit = (id) => {
    if (spdxIds.has(id)) return spdxIds.get(id);
    const { name, version: crateVersion, license, source } = cratesById.get(id);
    const checksum = checksums.get(`${name} ${crateVersion}`);
    const fields = source
      ? { downloadLocation: `https://static.crates.io/crates/${name}/${name}-${crateVersion}.crate`, ...purlFields(`pkg:cargo/${name}@${crateVersion}`) }
      : {};
    if (checksum) fields.checksums = [{ algorithm: 'SHA256', checksumValue: checksum }];
    // Old crates write "MIT/Apache-2.0", which is not valid in SPDX.
    const spdxId = addPackage('cargo', [name, ...(name === rootName ? excluded : [])].join(' without '), crateVersion, license?.replace(/\s*\/\s*/g, ' OR ') ?? 'NOASSERTION', fields);
    spdxIds.set(id, spdxId);
    for (const { pkg, dep_kinds } of nodesById.get(id).deps) {
      if (excluded.includes(cratesById.get(pkg).name)) continue;
      for (const { kind } of dep_kinds) {
        if (kind === null) relate(spdxId, 'DEPENDS_ON', visit(pkg));
        if (kind === 'build') relate(visit(pkg), 'BUILD_DEPENDENCY_OF', spdxId);
      }
    }
    return spdxId;
  };
  const rootCrate = metadata.packages.find(({ name, source }) => name === rootName && !source);
  relate(product, 'CONTAINS', visit(rootCrate.id));
}
const hostTarget = run('rustc', '--print', 'host-tuple').trim();
addCrates('crates', 'lizard-host', program, [], '--filter-platform', hostTarget);
for (const target of ['aarch64-unknown-linux-gnu', 'x86_64-pc-windows-gnu']) {
  addCrates('crates', 'lizard-host', programWithoutSimulator, ['simulated-uno', 'lizard-tune'], '--filter-platform', target);
}
addCrates('crates', 'lizard-web', page, [], '--filter-platform', 'wasm32-unknown-unknown');
// Cargo takes the AVR target from a file. The dependencies of these crates do not depend on the target.
addCrates('.', 'lizard', image, []);

const rustVersion = run('rustc', '--version').split(' ')[1];
const stdId = addPackage('rust', 'rust-std', rustVersion, 'MIT OR Apache-2.0', { downloadLocation: `https://static.rust-lang.org/dist/rustc-${rustVersion}-src.tar.gz` });
for (const product of [program, programWithoutSimulator, image, page]) relate(product, 'STATIC_LINK', stdId);

// --- Node's packages -------------------------------------------------------

/** Adds the packages of a lock file. A package is part of the page, or a tool that builds or tests it. */
function addNodePackages(folder) {
  const lock = JSON.parse(readFileSync(`${folder}/package-lock.json`, 'utf8'));
  for (const [path, entry] of Object.entries(lock.packages)) {
    if (path === '') continue;
    const name = path.slice(path.lastIndexOf('node_modules/') + 'node_modules/'.length);
    const fields = purlFields(`pkg:npm/${name.replace('@', '%40')}@${entry.version}`);
    if (entry.resolved) fields.downloadLocation = entry.resolved;
    const [algorithm, base64] = entry.integrity?.split('-') ?? [];
    if (base64) fields.checksums = [{ algorithm: algorithm.toUpperCase(), checksumValue: Buffer.from(base64, 'base64').toString('hex') }];
    const id = addPackage('npm', name, entry.version, entry.license ?? 'NOASSERTION', fields);
    if (entry.dev || entry.devOptional) relate(id, 'BUILD_TOOL_OF', page);
    else relate(page, 'CONTAINS', id);
  }
}
addNodePackages('web');
addNodePackages('tools/judge');

// --- Libraries from Debian -------------------------------------------------

/** Adds a Debian package whose library is part of a product. */
function addDebianPackage(name, license, product, type = 'STATIC_LINK') {
  const packageVersion = run('dpkg-query', '-W', '-f=${Version}', name);
  const [sourcePackage, sourceVersion] = run('dpkg-query', '-W', '-f=${source:Package} ${source:Version}', name).split(' ');
  const id = addPackage('debian', name, packageVersion, license, {
    ...purlFields(`pkg:deb/debian/${name}@${encodeURIComponent(packageVersion)}`),
    sourceInfo: `built from the Debian source package ${sourcePackage} ${sourceVersion}`,
  });
  relate(product, type, id);
}
addDebianPackage('libsimavr-dev', GPL, program);
addDebianPackage('libelf-dev', 'GPL-2.0-or-later OR LGPL-3.0-or-later', program);
addDebianPackage('zlib1g-dev', 'Zlib', program);
addDebianPackage('libc6-dev', 'LGPL-2.1-or-later', program);
addDebianPackage('libc6-dev-arm64-cross', 'LGPL-2.1-or-later', programWithoutSimulator);
addDebianPackage('mingw-w64-x86-64-dev', 'ZPL-2.1', programWithoutSimulator);
addDebianPackage('gcc-mingw-w64-x86-64-posix', 'GPL-3.0-or-later WITH GCC-exception-3.1', programWithoutSimulator);
addDebianPackage('avr-libc', 'BSD-3-Clause', image);
addDebianPackage('gcc-avr', 'GPL-3.0-or-later WITH GCC-exception-3.1', image);
addDebianPackage('arduino-core-avr', 'GPL-2.0-or-later', page, 'CONTAINS'); // optiboot

// --- The document ----------------------------------------------------------
const byId = (a, b) => (a.SPDXID < b.SPDXID ? -1 : 1);
console.log(JSON.stringify({
  spdxVersion: 'SPDX-2.3',
  dataLicense: 'CC0-1.0',
  SPDXID: 'SPDXRef-DOCUMENT',
  name: `lizard-${version}`,
  documentNamespace: `https://spdx.org/spdxdocs/lizard-${version}-${commit}`,
  creationInfo: { created: new Date(epoch * 1000).toISOString().replace('.000', ''), creators: [`Tool: lizard-spdx-${version}`] },
  packages: [...packages.values()].sort(byId),
  relationships: [...relationships].sort().map((line) => {
    const [spdxElementId, relationshipType, relatedSpdxElement] = line.split(' ');
    return { spdxElementId, relationshipType, relatedSpdxElement };
  }),
}, null, 1));
