// A Vite plugin that inserts the addresses of the repository and the page, from crates/Cargo.toml, into the page.
import { readFileSync } from 'node:fs';

const CARGO_TOML = new URL('../crates/Cargo.toml', import.meta.url);

/** Inserts the addresses of the repository and the page; removes the text around an empty address. */
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
