/* The cycle: approach and withdrawal at given gaps, its loop and its jumps. */

import { loop } from "./charts.js";
import { own } from "./controls.js";
import { points } from "./measured.js";
import { read, typed, written } from "./quantity.js";

/* The jumps that are told one by one. */
const MOST = 8;

export class Cycle {
  /* `onfollow()` is called when the cycle is asked for; `draw(id, chart)` draws a chart. */
  constructor(form, onfollow, draw) {
    [this.form, this.draw] = [form, draw];
    this.jumps = document.getElementById("jumps");
    [this.rows, this.units] = [[], {}];
    form.measured.addEventListener("change", () => this.show());
    // a file takes the place of what is there
    form.curve.addEventListener("change", async () => {
      form.measured.value = await form.curve.files[0].text();
      form.curve.value = "";
      this.show();
    });
    form.addEventListener("submit", event => {
      event.preventDefault();
      onfollow();
    });
  }

  /* Fits the gaps to a surface and a range of adhesion, from where the surfaces are apart, unless they have been typed
     for this one; forgets the cycle before. */
  fit({ lowest, highest, length, pressure }, range, boundary, again) {
    this.isFree = boundary === "free";
    [this.rows, this.units] = [[], { length, pressure, force: length && "N" }];
    this.show();
    this.jumps.textContent = "";
    document.getElementById("from").textContent = this.isFree ? "from an approach of" : "from a gap of";
    const inputs = [this.form.cycle_from, this.form.cycle_to],
      isTyped = inputs.some(({ value, defaultValue }) => value !== defaultValue);
    if (isTyped && !again) return;
    const reach = 5 * (typed(range ?? "0")?.value ?? 0);
    const turns = this.isFree ? [-reach, 0.2 * (highest - lowest)] : [highest + reach, 0.3 * highest];
    // what is not typed is the default
    inputs.forEach((input, k) => (input.value = input.defaultValue = written(turns[k], length)));
  }

  get scene() {
    const { cycle_from: from, cycle_to: to, cycle_steps: steps } = this.form;
    const turns = [from, to, from].map(({ value }) => value.trim()).join(",");
    return { [this.isFree ? "approaches" : "mean_gaps"]: turns, steps: Number(steps.value) };
  }

  /* Draws the loop as far as it is known, over the measured curve. */
  show() {
    const output = document.querySelector("[data-of=measured]");
    let measured = [];
    output.textContent = "";
    try {
      measured = points(this.form.measured.value);
    } catch ({ message }) {
      output.textContent = message;
    }
    this.draw("loop", this.rows.length || measured.length ? loop(this.rows, this.isFree, this.units, measured) : null);
  }

  /* Follows the cycle of a scene, and draws it as it grows; `onstate` hears of each state. */
  async follow(engine, scene, onstate) {
    const rows = (this.rows = []);
    this.jumps.textContent = "";
    const { shortfalls, limit } = await engine.follow(
      { ...scene, ...this.scene },
      {
        onstate: (row, { share }) => {
          rows.push(row);
          onstate({ ...row, count: rows.length, share: share ?? 0 });
          this.show();
        },
      },
    );
    this.jumps.textContent = [this.told(rows), ...this.limits(limit), ...shortfalls.map(own)].join(" ");
  }

  /* The jumps in a sentence, the largest first. */
  told(rows) {
    const jumps = rows.filter(row => row.energy_drop > 0).sort((a, b) => b.energy_drop - a.energy_drop);
    if (!jumps.length) return "There is no jump.";
    const each = jumps.slice(0, MOST).map(row => {
      const { length } = this.units,
        place = read(row[this.isFree ? "approach" : "mean_gap"], length);
      return `${row.event} at ${place}: ${read(row.energy_drop, length && "J/m²")}`;
    });
    const which = jumps.length > MOST ? ` of the largest ${MOST}` : "";
    return `Jumps: ${jumps.length}, with the energy per area that each${which} dissipates: ${each.join("; ")}.`;
  }

  /* The limits of no range in a sentence, where there are some. */
  limits(limit) {
    if (!limit) return [];
    const { length, pressure } = this.units,
      told = (name, unit) => `${read(limit[name], unit)} ± ${read(limit[`${name}_error`], unit)}`;
    const [work, tension] = [told("work_limit", length && "J/m²"), told("tension_limit", pressure)];
    return [`In the limit of no range the cycle takes ${work} per area, and the greatest tension is ${tension}.`];
  }
}
