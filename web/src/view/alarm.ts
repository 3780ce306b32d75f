// The alarm for a robot that does not answer: the page then shows an outdated state, and the robot may still walk.
import type { Session } from '../session';
import { SILENCE_MS } from '../link/dialogue';
import { element, setText } from './elements';

/** Shows the alarm while the robot is silent; returns the function that updates the alarm's message and duration. */
export function setUpAlarm({ state }: Session): () => void {
  const box = element('alarm');
  /** The time since which the robot has been silent, on the page's clock, ms. */
  let silentSince = 0;
  const update = () => {
    if (box.hidden) return;
    const message = state.isStopping.value ? 'No answer: the robot may still walk. The page repeats "stop" until the robot answers.' : 'No answer from the robot.';
    setText(element('alarm-message'), message);
    element('alarm-age').textContent = `${((performance.now() - silentSince) / 1000).toFixed(1)} s`;
  };
  state.isSilent.subscribe((isSilent) => {
    silentSince = performance.now() - SILENCE_MS;
    box.hidden = !isSilent;
    update();
  });
  state.isStopping.subscribe((isStopping) => {
    document.body.classList.toggle('stopping', isStopping);
    update();
  });
  return update;
}
