/* The profile along a line over the maps: the nodes from one to another. */

import { typed } from "./quantity.js";

export class Profile {
  /* `maps` show the line, and take another one while the button is on; `onchange()` hears of it. */
  constructor(button, maps, onchange) {
    Object.assign(this, { button, maps, onchange, isOn: false, input: document.getElementsByName("line")[0] });
    button.addEventListener("click", () => {
      this.isOn = !this.isOn;
      this.show();
    });
  }

  /* The ends of the line in shares of the sides, from left to right and from below. */
  get line() {
    return this.input.value.split(" ").map(Number);
  }

  set(line) {
    this.input.value = line.join(" ");
    this.show();
    this.onchange();
  }

  /* Moves the end of the line to a node of a shape, or its start and end. */
  draw(node, shape, isStart) {
    const place = node.map((k, axis) => Number(((k + 0.5) / shape[axis]).toFixed(4)));
    this.set(isStart ? [...place, ...place] : [...this.line.slice(0, 2), ...place]);
  }

  /* Shows the line on the maps. */
  show() {
    this.button.setAttribute("aria-pressed", this.isOn);
    for (const map of this.maps) map.drawLine(this.line, this.isOn);
  }

  /* The charts along the line: surface and body, and the pressure. A solution of a part of the surface is of its corner. */
  charts({ shape, lengths, length, pressure, fields }, surface) {
    const [from, to] = [this.line.slice(0, 2), this.line.slice(2)].map(place =>
      place.map((share, axis) => Math.min(shape[axis] - 1, Math.floor(share * shape[axis]))),
    );
    const way = to.map((k, axis) => k - from[axis]),
      steps = Math.max(...way.map(Math.abs), 1);
    const long = Math.hypot(...way.map((k, axis) => (k * lengths[axis]) / shape[axis]));
    const along = of =>
      Array.from({ length: steps + 1 }, (_, k) => {
        const [i, j] = from.map((at, axis) => at + Math.round((k / steps) * way[axis]));
        return [(k / steps) * long, of(i, j)];
      });
    const at = (values, ny) => (i, j) => values[i * ny + j];
    const [gap, load] = [fields.gap, fields.pressure].map(values => at(values, shape[1])),
      height = at(surface.heights, surface.shape[1]);
    const scale = surface.length === length ? 1 : typed(`1${surface.length}`)?.value;
    const body = along((i, j) => scale * height(i, j) + gap(i, j)),
      below = along((i, j) => scale * height(i, j));
    const chart = (y_label, y_unit, curves) => ({ x_label: "along the line", x_unit: length, y_label, y_unit, curves });
    return {
      sides: chart("height", length, Object.entries({ body, surface: below })),
      loads: chart("pressure", pressure, [["", along(load)]]),
    };
  }
}
