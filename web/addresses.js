// A Vite plugin that fills the addresses of the repository and of the page, from crates/Cargo.toml, into the page.
import { readFileSync } from 'node:fs';

const CARGO_TOML = new URL('../crates/Cargo.toml', import.meta.url);

/** Fills in the addresses of the repository and of the page; removes the text around an address that is empty. */
const fillAddresses = (html, cargoToml) =>
  ['repository', 'homepage'].reduce((filled, name) => {
    const [, address] = new RegExp(`^${name} = "(.*?)"`, 'm').exec(cargoToml);
    const comment = new RegExp(`<!-- with a ${name}: (.*) -->`, 'g');
    return filled.replace(comment, (_, content) => (address ? content.replaceAll(name.toUpperCase(), address) : ''));
  }, html);

export const addresses = () => ({
  name: 'addresses',
  transformIndexHtml: (html) => fillAddresses(html, readFileSync(CARGO_TOML, 'utf8')),
});
