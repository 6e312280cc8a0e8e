/* The load: a slider over the loads that the surface bears, and the quantity that it stands for. */

import { typed, written } from "./quantity.js";

/* Where the slider begins, as a share of its way. */
const START = 0.5;

export class Load {
  /* `onload()` is called when the load changes. */
  constructor(form, onload) {
    [this.control, this.value, this.slider] = [form.control, form.value, form.querySelector("#drag")];
    form.addEventListener("submit", event => event.preventDefault());
    this.slider.addEventListener("input", () => {
      this.to(Number(this.slider.value));
      onload();
    });
    this.value.addEventListener("change", () => {
      this.isDragged = false;
      this.place();
      onload();
    });
    this.control.addEventListener("change", () => {
      const found = this.found?.[this.control.value];
      if (this.isChosen || !Number.isFinite(found)) this.choose();
      else this.value.value = written(found, this.unit(), 4);
      this.place();
      onload();
    });
  }

  /* Whether the page has chosen the load, which is the default of its input then. */
  get isChosen() {
    return this.value.value === this.value.defaultValue;
  }

  choose() {
    this.value.value = this.value.defaultValue = this.text(START);
  }

  /* Fits the loads to a surface: its heights over their mean, slope, sides and area, all in units of `length`, and the
     modulus. A load that the page has chosen is chosen again, on `another` surface also one of the slider; a load that
     was typed stays. */
  fit({ lowest, highest, slope, area, length }, { value: modulus, unit }, boundary, another) {
    // a surface that is flat, or of absurd heights, has loads, too
    const sound = (value, otherwise) => (value > 0 && value < 1e50 ? value : otherwise);
    const free = boundary === "free",
      full = modulus * sound(slope, 0.01),
      pressures = [1e-3 * full, 2 * full];
    const high = sound(highest, 0.01 * Math.sqrt(area)),
      deep = sound(highest - lowest, high);
    this.units = { mean_pressure: unit, mean_gap: length, normal_force: unit && "N", approach: length };
    this.ranges = {
      mean_pressure: { log: pressures },
      normal_force: { log: pressures.map(pressure => pressure * area) },
      // more load is less gap
      mean_gap: { log: [1.3 * high, 3e-3 * high] },
      approach: { linear: [-0.1 * deep, 0.5 * deep] },
    };
    for (const option of this.control.options) {
      option.hidden = option.disabled = option.value === (free ? "mean_gap" : "approach");
    }
    const isOff = this.control.selectedOptions[0].disabled;
    if (isOff) this.control.value = free ? "normal_force" : "mean_pressure";
    if (isOff || this.isChosen || !this.value.value || (another && this.isDragged)) this.choose();
    this.place();
  }

  unit() {
    return this.units[this.control.value];
  }

  /* The load at a share of the way of the slider, as one types it. */
  text(share) {
    const { log, linear } = this.ranges[this.control.value];
    const [from, to] = log ? log.map(Math.log) : linear,
      at = from + share * (to - from);
    return written(log ? Math.exp(at) : at, this.unit());
  }

  /* Takes the load at a share of the way. */
  to(share) {
    this.isDragged = true;
    this.slider.value = share;
    this.value.value = this.text(share);
    this.tell();
  }

  /* Puts the slider where the load is. */
  place() {
    const { log, linear } = this.ranges[this.control.value],
      at = typed(this.value.value)?.value;
    const [from, to] = log ? log.map(Math.log) : linear;
    if (Number.isFinite(at)) this.slider.value = log && at <= 0 ? 0 : ((log ? Math.log(at) : at) - from) / (to - from);
    this.tell();
  }

  tell() {
    this.slider.setAttribute("aria-valuetext", `${this.control.selectedOptions[0].text} ${this.value.value}`);
  }

  get scene() {
    return { [this.control.value]: this.value.value.trim() };
  }
}
