// Predicts the gaits of the page's robots during the build, so that a phone does not need to. Writes
// NAME.predictions.json next to each NAME.toml in a folder, which must also contain lizard.wasm.
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { initSync, Robot } from './generated/lizard.js';

const [folder] = process.argv.slice(2);
initSync({ module: readFileSync(join(folder, 'lizard.wasm')) });
const robot = new Robot();
for (const name of readdirSync(folder).filter((file) => file.endsWith('.toml'))) {
  const { gaits } = robot.load(readFileSync(join(folder, name), 'utf8'));
  writeFileSync(join(folder, name.replace(/toml$/, 'predictions.json')), JSON.stringify(gaits.map((_, index) => robot.predict(index))));
}
