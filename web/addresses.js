// A Vite plugin that inserts into the page the addresses of the repository and of the page itself, from
// crates/Cargo.toml.
import { readFileSync } from 'node:fs';

const CARGO_TOML = new URL('../crates/Cargo.toml', import.meta.url);

/**
 * Replaces each comment `<!-- with a repository: ... -->` or `<!-- with a homepage: ... -->` with its content, and in
 * it REPOSITORY or HOMEPAGE with the address. Removes the comment if crates/Cargo.toml has an empty address.
 */
const insertAddresses = (html, cargoToml) =>
  ['repository', 'homepage'].reduce((currentHtml, name) => {
    const [, address] = new RegExp(`^${name} = "(.*?)"`, 'm').exec(cargoToml);
    const commentPattern = new RegExp(`<!-- with a ${name}: (.*) -->`, 'g');
    return currentHtml.replace(commentPattern, (_, content) => (address ? content.replaceAll(name.toUpperCase(), address) : ''));
  }, html);

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => insertAddresses(html, readFileSync(CARGO_TOML, 'utf8')),
});
