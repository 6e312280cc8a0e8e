/* The player: goes through the loads of the slider, and waits for each contact. */

/* The steps from the lightest load to the heaviest, and the least time of one in milliseconds. */
const STEPS = 40,
  PAUSE = 150;

export class Player {
  /* `onstep(share)` puts the slider to a share of its way, and returns when the contact is there. */
  constructor(button, slider, onstep) {
    Object.assign(this, { button, slider, onstep, isOn: false });
    button.addEventListener("click", () => (this.isOn ? this.stop() : this.play()));
  }

  /* Goes on from where the slider is, or from the start if it is at the end. */
  async play() {
    this.turn(true);
    let share = Number(this.slider.value);
    if (share >= 1) share = -1 / STEPS;
    while (this.isOn && share < 1) {
      share = Math.min(1, share + 1 / STEPS);
      await Promise.all([this.onstep(share), new Promise(done => setTimeout(done, PAUSE))]);
    }
    this.stop();
  }

  stop() {
    this.turn(false);
  }

  turn(isOn) {
    this.isOn = isOn;
    this.button.textContent = isOn ? "Stop" : "Play";
  }
}
