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
      this.place();
      onload();
    });
    this.control.addEventListener("change", () => {
      const found = this.found?.[this.control.value];
      this.value.value = Number.isFinite(found) ? written(found, this.unit(), 4) : this.text(START);
      this.place();
      onload();
    });
  }

  /* Fits the loads to a surface: its heights over their mean, slope, sides and area, all in units of `length`, and the
     modulus; `again` begins anew. */
  fit({ lowest, highest, slope, area, length }, { value: modulus, unit }, boundary, again) {
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
    if (this.control.selectedOptions[0].disabled) {
      this.control.value = free ? "normal_force" : "mean_pressure";
      again = true;
    }
    if (again || !this.value.value) this.value.value = this.text(START);
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
