// Puts the project's addresses, which crates/Cargo.toml has, into the page.
import { readFileSync } from 'node:fs';

/** Fills in the addresses of the repository and of the page, or removes what mentions one while it is empty. */
export const quoted = (html, cargo) =>
  ['repository', 'homepage'].reduce((html, name) => {
    const [, address] = new RegExp(`^${name} = "(.*?)"`, 'm').exec(cargo);
    return html.replace(new RegExp(`<!-- with a ${name}: (.*) -->`, 'g'), (_, shown) => (address ? shown.replaceAll(name.toUpperCase(), address) : ''));
  }, html);

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => quoted(html, readFileSync(new URL('../crates/Cargo.toml', import.meta.url), 'utf8')),
});
