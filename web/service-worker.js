// Stores all files of the page when the page is first opened, so that the page works without a network. The build
// prepends two constants to this code: FILES, a list of all paths with the SHA-256 of their bytes, and BUILD, the
// SHA-256 of this list.

/** The prefix of this page's cache names. Other pages of the same origin have other prefixes. */
const CACHE_PREFIX = `lizard ${new URL(self.registration.scope).pathname} `;
const CACHE_NAME = CACHE_PREFIX + BUILD;

const toUrl = (path) => new URL(path, self.registration.scope).href;

async function computeHash(bytes) {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}

/** Loads a file of this build from an older cache or from the server. Throws if the server has another version. */
async function loadVerifiedFile(path, hash) {
  for (const name of await caches.keys()) {
    if (!name.startsWith(CACHE_PREFIX)) continue;
    const cached = await (await caches.open(name)).match(toUrl(path));
    if (cached && (await computeHash(await cached.clone().arrayBuffer())) === hash) return cached;
  }
  const response = await fetch(toUrl(path), { cache: 'no-cache' });
  const isVerified = response.ok && (await computeHash(await response.clone().arrayBuffer())) === hash;
  if (!isVerified) throw new Error(`${path} does not belong to this build of the page`);
  return response;
}

/** Stores all files or none: if a file is missing, the older build stays in use. */
async function install() {
  const files = await Promise.all(FILES.map(async ([path, hash]) => [path, await loadVerifiedFile(path, hash)]));
  const cache = await caches.open(CACHE_NAME);
  // A browser refuses to show a stored page whose response was redirected. Some servers redirect /index.html to /.
  for (const [path, response] of files) await cache.put(toUrl(path), response.redirected ? new Response(response.body, response) : response);
}
self.addEventListener('install', (event) => event.waitUntil(install()));

async function activate() {
  for (const name of await caches.keys()) if (name.startsWith(CACHE_PREFIX) && name !== CACHE_NAME) await caches.delete(name);
  await self.clients.claim();
}
self.addEventListener('activate', (event) => event.waitUntil(activate()));

// The older page sends this message when the user requests the newer build.
self.addEventListener('message', ({ data }) => {
  if (data === 'take over') void self.skipWaiting();
});

async function respond(request) {
  const { origin, pathname } = new URL(request.url);
  const address = origin + pathname === self.registration.scope ? toUrl('index.html') : origin + pathname;
  return (await (await caches.open(CACHE_NAME)).match(address)) ?? fetch(request);
}
self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || !request.url.startsWith(self.registration.scope)) return;
  event.respondWith(respond(request));
});
