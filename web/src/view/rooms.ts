// The rooms beside the stage, of which one is open. The part `room` of the address names it, so that links and the
// browser's Back open it.
import { partsOf } from '../address';

/** The name of the document's event after another room was opened. */
export const OPENED = 'room';

const FIRST_ROOM = 'start';
const PAGE_NAME = document.title;

const idOf = (room: string) => `room-${room}`;
const rooms = () => [...document.querySelectorAll<HTMLElement>('.room')];

/** Opens the room that an address names, or the first one. */
export function openRoom(hash: string): void {
  const requestedId = idOf(partsOf(hash).get('room') ?? FIRST_ROOM);
  const room = rooms().find(({ id }) => id === requestedId) ?? rooms()[0];
  if (!room || room.id === document.body.dataset.at) return;
  for (const candidate of rooms()) candidate.hidden = candidate !== room;
  for (const link of document.querySelectorAll<HTMLAnchorElement>('nav a')) {
    const isOpenRoom = idOf(partsOf(link.hash).get('room') ?? '') === room.id;
    if (isOpenRoom) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  }
  document.body.dataset.at = room.id;
  document.title = `${room.querySelector('h2')?.textContent}, ${PAGE_NAME}`;
  scrollTo(0, 0);
  document.dispatchEvent(new Event(OPENED));
  // Its panels show what they have missed.
  for (const panel of room.querySelectorAll('details[open]')) panel.dispatchEvent(new Event('toggle'));
}

/** True if a panel is unfolded and its room is open; a panel that is not shown draws nothing. */
export const isShown = (panel: HTMLDetailsElement) => panel.open && panel.closest<HTMLElement>('.room')?.hidden === false;

/** Opens the room of an element, and its panel. */
export function reveal(target: HTMLElement): void {
  const room = target.closest('.room');
  const panel = target.closest('details');
  if (panel) panel.open = true;
  if (!room || room.id === document.body.dataset.at) return;
  location.hash = `room=${room.id.slice(idOf('').length)}`;
  openRoom(location.hash);
}
