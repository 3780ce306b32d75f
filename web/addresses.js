// The project's addresses, which crates/Cargo.toml has, in the page.
import { readFileSync } from 'node:fs';

/** Shows what the page has for the repository and for its own address, or nothing while they are empty. */
export const quoted = (html, cargo) =>
  ['repository', 'homepage'].reduce((html, name) => {
    const [, address] = new RegExp(`^${name} = "(.*?)"`, 'm').exec(cargo);
    return html.replace(new RegExp(`<!-- with a ${name}: (.*) -->`, 'g'), (_, shown) => (address ? shown.replaceAll(name.toUpperCase(), address) : ''));
  }, html);

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => quoted(html, readFileSync(new URL('../crates/Cargo.toml', import.meta.url), 'utf8')),
});
