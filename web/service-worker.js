// Stores all files of one build of the page when the page is first opened, so that it works without a network. The
// build puts two constants in front of this code: FILES, the list of all paths with the SHA-256 of their bytes, and
// BUILD, the SHA-256 of that list.

/** The prefix of the names of this page's caches, which other pages of the same origin do not share. */
const CACHE_PREFIX = `lizard ${new URL(self.registration.scope).pathname} `;
const CACHE_NAME = CACHE_PREFIX + BUILD;

const addressOf = (path) => new URL(path, self.registration.scope).href;

async function hashOf(bytes) {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}

/** Returns a file of this build from an older cache or from the server. Throws if the server has another version. */
async function loadVerifiedFile(path, hash) {
  for (const name of await caches.keys()) {
    if (!name.startsWith(CACHE_PREFIX)) continue;
    const cached = await (await caches.open(name)).match(addressOf(path));
    if (cached && (await hashOf(await cached.clone().arrayBuffer())) === hash) return cached;
  }
  const response = await fetch(addressOf(path), { cache: 'no-cache' });
  const isExpected = response.ok && (await hashOf(await response.clone().arrayBuffer())) === hash;
  if (!isExpected) throw new Error(`${path} is not what was built together with the page`);
  return response;
}

// Stores all files or none: if one is missing, the older build stays in use.
self.addEventListener('install', (event) => {
  event.waitUntil(
    (async () => {
      const files = await Promise.all(FILES.map(async ([path, hash]) => [path, await loadVerifiedFile(path, hash)]));
      const cache = await caches.open(CACHE_NAME);
      for (const [path, response] of files) await cache.put(addressOf(path), response);
    })(),
  );
});

self.addEventListener('activate', (event) => {
  event.waitUntil(
    (async () => {
      for (const name of await caches.keys()) if (name.startsWith(CACHE_PREFIX) && name !== CACHE_NAME) await caches.delete(name);
      await self.clients.claim();
    })(),
  );
});

// The user has asked for the newer page.
self.addEventListener('message', ({ data }) => {
  if (data === 'take over') void self.skipWaiting();
});

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || !request.url.startsWith(self.registration.scope)) return;
  event.respondWith(
    (async () => {
      const url = new URL(request.url);
      const address = url.href === self.registration.scope || request.mode === 'navigate' ? addressOf('index.html') : url.origin + url.pathname;
      return (await (await caches.open(CACHE_NAME)).match(address)) ?? fetch(request);
    })(),
  );
});
