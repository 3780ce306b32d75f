// The project's addresses, which crates/Cargo.toml has, in the page.
import { readFileSync } from 'node:fs';

/** Shows what the page has for the repository, or nothing while it has no address. */
export function quoted(html, cargo) {
  const [, repository] = /^repository = "(.*)"/m.exec(cargo);
  return html.replace(/<!-- with a repository: (.*) -->/g, (_, shown) => (repository ? shown.replaceAll('REPOSITORY', repository) : ''));
}

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => quoted(html, readFileSync(new URL('../crates/Cargo.toml', import.meta.url), 'utf8')),
});
