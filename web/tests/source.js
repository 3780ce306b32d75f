// A module of the page's source without a browser.
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

/** Imports a file of web/src with what it imports, as a browser gets it. */
export async function importSource(path) {
  const rolldown = createRequire(new URL('../package.json', import.meta.url)).resolve('rolldown');
  const { rolldown: bundle } = await import(pathToFileURL(rolldown));
  const build = await bundle({ input: new URL(`../src/${path}`, import.meta.url).pathname });
  const { output: [{ code }] } = await build.generate({ format: 'esm' });
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}
