// The rooms next to the stage, of which one is open. The parameter `room` of the page's address names the open room, so
// that links and the browser's Back button open rooms.
import { parseFragment } from '../address';
import type { Description } from '../robot';
import type { Session } from '../session';
import { setAttribute } from './elements';

/** The type of the event that the document receives after another room is opened. */
export const ROOM_OPENED = 'room';

const FIRST_ROOM = 'start';
const PAGE_NAME = document.title;

const toRoomId = (room: string) => `room-${room}`;
const findRooms = () => [...document.querySelectorAll<HTMLElement>('.room')];

/** Opens the room that an address's fragment names, or the first room. */
export function openRoom(hash: string): void {
  const requestedId = toRoomId(parseFragment(hash).get('room') ?? FIRST_ROOM);
  const room = findRooms().find(({ id }) => id === requestedId) ?? findRooms()[0];
  if (!room || room.id === document.body.dataset.at) return;
  for (const candidate of findRooms()) candidate.hidden = candidate !== room;
  for (const link of document.querySelectorAll<HTMLAnchorElement>('nav a')) {
    const isOpenRoom = toRoomId(parseFragment(link.hash).get('room') ?? '') === room.id;
    setAttribute(link, 'aria-current', isOpenRoom ? 'page' : null);
  }
  document.body.dataset.at = room.id;
  document.title = `${room.querySelector('h2')?.textContent}, ${PAGE_NAME}`;
  scrollTo(0, 0);
  document.dispatchEvent(new Event(ROOM_OPENED));
  // Tells the unfolded panels to draw what changed while the room was closed.
  for (const panel of room.querySelectorAll('details[open]')) panel.dispatchEvent(new Event('toggle'));
}

/** Returns true if a panel is unfolded and its room is open; other panels draw nothing. */
export const isShown = (panel: HTMLDetailsElement) => panel.open && panel.closest<HTMLElement>('.room')?.hidden === false;

/**
 * Calls `show` when the panel is shown, and when the robot changes while the panel is shown, unless robot.toml, floor
 * and servos are the same as in the last call.
 */
export function followShownRobot(panel: HTMLDetailsElement, session: Session, show: (description: Description) => void): void {
  let shownKey = '';
  const update = () => {
    if (!isShown(panel) || session.robot.toml === '') return;
    const { toml, description, floor, servos } = session.robot;
    const key = JSON.stringify([toml, floor, servos]);
    if (key === shownKey) return;
    shownKey = key;
    show(description);
  };
  panel.addEventListener('toggle', update);
  session.robot.follow(update);
}

/** Opens the room and the panel of an element. */
export function reveal(target: HTMLElement): void {
  const room = target.closest('.room');
  const panel = target.closest('details');
  if (panel) panel.open = true;
  if (!room || room.id === document.body.dataset.at) return;
  location.hash = `room=${room.id.slice(toRoomId('').length)}`;
  openRoom(location.hash);
}
