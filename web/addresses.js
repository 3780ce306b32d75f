// Puts the project's addresses, which crates/Cargo.toml has, into the page.
import { readFileSync } from 'node:fs';

/** Fills in the address of the repository, or removes what mentions it while it has none. */
export function quoted(html, cargo) {
  const [, repository] = /^repository = "(.*)"/m.exec(cargo);
  return html.replace(/<!-- with a repository: (.*) -->/g, (_, shown) => (repository ? shown.replaceAll('REPOSITORY', repository) : ''));
}

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => quoted(html, readFileSync(new URL('../crates/Cargo.toml', import.meta.url), 'utf8')),
});
