/// <reference types="vite/client" />
// The page without a network: a service worker (service-worker.js) stores all files. A newer version is loaded only at
// the user's request, never automatically while the robot walks.
import { getMessage } from './problem';

/** Stores the page on this machine. Once a newer version is ready, calls `onUpdate` with a function that loads it. */
export async function installServiceWorker(onUpdate: (load: () => void) => void): Promise<void> {
  // Browsers have service workers only over https and on localhost; otherwise the page needs the network.
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  const { serviceWorker } = navigator;
  const isFirstVisit = serviceWorker.controller === null;
  try {
    const registration = await serviceWorker.register(new URL('service-worker.js', document.baseURI), { updateViaCache: 'none' });
    const offerUpdate = () => {
      const { waiting } = registration;
      if (!waiting || isFirstVisit) return;
      onUpdate(() => {
        // Another tab has loaded the newer version.
        if (waiting.state !== 'installed') return location.reload();
        serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
        waiting.postMessage('take over');
      });
    };
    offerUpdate();
    registration.addEventListener('updatefound', () => registration.installing?.addEventListener('statechange', offerUpdate));
  } catch (error) {
    console.info(`Cannot store the page for use without a network: ${getMessage(error)}`);
  }
}
