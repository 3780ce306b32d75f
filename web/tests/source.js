// Imports modules of the page's source without a browser.
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

/** Bundles a file of web/src with its imports, and imports the bundle. */
export async function importSource(path) {
  const rolldownPath = createRequire(new URL('../package.json', import.meta.url)).resolve('rolldown');
  const { rolldown: bundle } = await import(pathToFileURL(rolldownPath));
  const build = await bundle({ input: new URL(`../src/${path}`, import.meta.url).pathname });
  const { output: [{ code }] } = await build.generate({ format: 'esm' });
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}
