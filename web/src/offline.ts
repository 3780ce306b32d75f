/// <reference types="vite/client" />
// The page without a network: a service worker (service-worker.js) stores all files, and a newer page is loaded only when
// the user says so, never while the robot walks.
import { messageOf } from './trouble';

/**
 * Stores the page on this machine. Calls `onUpdate` when a newer page is ready, with a function that loads the newer
 * page.
 */
export async function keepOffline(onUpdate: (load: () => void) => void): Promise<void> {
  // Only over https and on localhost; otherwise the page needs the network.
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  const { serviceWorker } = navigator;
  const isFirstVisit = serviceWorker.controller === null;
  try {
    const registration = await serviceWorker.register(new URL('service-worker.js', document.baseURI), { updateViaCache: 'none' });
    const offerUpdate = () => {
      const { waiting } = registration;
      if (!waiting || isFirstVisit) return;
      onUpdate(() => {
        serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
        waiting.postMessage('take over');
      });
    };
    offerUpdate();
    registration.addEventListener('updatefound', () => registration.installing?.addEventListener('statechange', offerUpdate));
  } catch (error) {
    console.info(`The page is not kept for use without a network: ${messageOf(error)}`);
  }
}
