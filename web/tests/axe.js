// Accessibility violations, found by axe-core.
import { createRequire } from 'node:module';

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

/** Returns the violations in an element or in the whole page, which must have been opened with `bypassCSP`. */
export async function findViolations(page, selector = 'html') {
  if (!(await page.evaluate(() => 'axe' in window))) await page.addScriptTag({ path: AXE });
  const { violations } = await page.evaluate((selector) => window.axe.run(selector, { resultTypes: ['violations'] }), selector);
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join('\n')}`);
}
