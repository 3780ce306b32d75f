// A Vite plugin that inserts the addresses of the repository and the page, from crates/Cargo.toml, into the page.
import { readFileSync } from 'node:fs';

const CARGO_TOML = new URL('../crates/Cargo.toml', import.meta.url);

/**
 * Replaces each comment `<!-- with a repository: ... -->` or `<!-- with a homepage: ... -->` by its content, in which
 * the address replaces the word in capitals. Removes the comment if crates/Cargo.toml has an empty address.
 */
const insertAddresses = (html, cargoToml) =>
  ['repository', 'homepage'].reduce((newHtml, name) => {
    const [, address] = new RegExp(`^${name} = "(.*?)"`, 'm').exec(cargoToml);
    const comment = new RegExp(`<!-- with a ${name}: (.*) -->`, 'g');
    return newHtml.replace(comment, (_, content) => (address ? content.replaceAll(name.toUpperCase(), address) : ''));
  }, html);

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => insertAddresses(html, readFileSync(CARGO_TOML, 'utf8')),
});
