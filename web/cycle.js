/* The cycle: approach and withdrawal at given gaps, its loop and its jumps. */

import { loop } from "./charts.js";
import { read, typed, written } from "./quantity.js";

/* The jumps that are told one by one. */
const MOST = 8;

export class Cycle {
  /* `onfollow()` is called when the cycle is asked for; `draw(id, chart)` draws a chart. */
  constructor(form, onfollow, draw) {
    [this.form, this.draw] = [form, draw];
    [this.chart, this.jumps] = ["loop", "jumps"].map(id => document.getElementById(id));
    form.addEventListener("submit", event => {
      event.preventDefault();
      onfollow();
    });
    for (const input of [form.cycle_from, form.cycle_to]) input.addEventListener("input", () => (this.isTyped = true));
  }

  /* Fits the gaps to a surface and a range of adhesion, from where the surfaces are apart, unless they have been typed
     for this one; forgets the cycle before. */
  fit({ lowest, highest, length }, range, boundary, again) {
    this.isFree = boundary === "free";
    this.chart.replaceChildren();
    this.jumps.textContent = "";
    document.getElementById("from").textContent = this.isFree ? "from an approach of" : "from a gap of";
    if (this.isTyped && !again) return;
    const reach = 5 * (typed(range ?? "0")?.value ?? 0);
    const turns = this.isFree ? [-reach, 0.2 * (highest - lowest)] : [highest + reach, 0.3 * highest];
    [this.form.cycle_from.value, this.form.cycle_to.value] = turns.map(value => written(value, length));
    this.isTyped = false;
  }

  get scene() {
    const { cycle_from: from, cycle_to: to, cycle_steps: steps } = this.form;
    const turns = [from, to, from].map(({ value }) => value.trim()).join(",");
    return { [this.isFree ? "approaches" : "mean_gaps"]: turns, steps: Number(steps.value) };
  }

  /* Follows the cycle of a scene, and draws it as it grows; `onstate` hears of each state. */
  async follow(engine, scene, units, onstate) {
    const rows = [];
    this.jumps.textContent = "";
    const { shortfalls } = await engine.follow(
      { ...scene, ...this.scene },
      {
        onstate: (row, { share }) => {
          rows.push(row);
          onstate({ ...row, count: rows.length, share: share ?? 0 });
          this.draw(this.chart.id, loop(rows, this.isFree, units));
        },
      },
    );
    this.jumps.textContent = [this.told(rows, units), ...shortfalls].join(" ");
  }

  /* The jumps in a sentence, the largest first. */
  told(rows, units) {
    const jumps = rows.filter(row => row.energy_drop > 0).sort((a, b) => b.energy_drop - a.energy_drop);
    if (!jumps.length) return "There is no jump.";
    const each = jumps.slice(0, MOST).map(row => {
      const place = read(row[this.isFree ? "approach" : "mean_gap"], units.length);
      return `${row.event} at ${place}: ${read(row.energy_drop, units.length && "J/m²")}`;
    });
    const which = jumps.length > MOST ? ` of the largest ${MOST}` : "";
    return `Jumps: ${jumps.length}, with the energy per area that each${which} dissipates: ${each.join("; ")}.`;
  }
}
