// The slider for the pace of all gaits, which also shows the reported pace.
import type { Session } from '../session';
import { WORDS } from '../words';
import { element, showSliderText } from './elements';

export function setUpPace(session: Session): void {
  const slider = element<HTMLInputElement>('speed');
  /** True between the user's first move of the slider and the answer to the line with its value. */
  let isPending = false;
  const showText = (percent: number) => showSliderText(slider, `${percent} %`);
  /** Shows the robot's pace in percent, unless the user is changing it. */
  const show = (percent: number) => {
    if (isPending) return;
    slider.value = String(percent);
    showText(percent);
  };
  slider.addEventListener('input', () => {
    isPending = true;
    showText(slider.valueAsNumber);
  });
  slider.addEventListener('change', () => {
    isPending = true;
    void session.board.drive(`${WORDS.speed} ${slider.value}`).finally(() => {
      isPending = false;
      show(session.board.pace);
    });
  });
  session.state.pace.subscribe(show);
}
