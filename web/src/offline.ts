/// <reference types="vite/client" />
// The page without a network: a service worker (service-worker.js) keeps all of its files, and a newer page is taken when a
// person says so, never under a robot that walks.
import { sentence } from './trouble';

/** Keeps the page on this machine; `fresh` is told of a newer one, and calls what it gets to take that. */
export async function keepOffline(fresh: (take: () => void) => void): Promise<void> {
  // Browsers have it over https and on localhost; without it the page works as long as there is a network.
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  const { serviceWorker } = navigator;
  const isFirst = serviceWorker.controller === null;
  try {
    const registration = await serviceWorker.register(new URL('service-worker.js', document.baseURI), { updateViaCache: 'none' });
    const offer = () => {
      const { waiting } = registration;
      if (!waiting || isFirst) return;
      fresh(() => {
        serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
        waiting.postMessage('take over');
      });
    };
    offer();
    registration.addEventListener('updatefound', () => registration.installing?.addEventListener('statechange', offer));
  } catch (error) {
    console.info(`The page is not kept for use without a network: ${sentence(error)}`);
  }
}
