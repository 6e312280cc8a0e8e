/* The maps of the page: heights, contact, pressure and gap, which are read together. */

import { FieldMap, colouring } from "./map.js";
import { read } from "./quantity.js";

/* The classes of contact, by their numbers. */
const CLASSES = ["apart", "contact", "nothing there", "attractive", "yielded"];
const WHITE = [255, 255, 255];
const BLACK = [0, 0, 0];

export class Maps {
  constructor(colours) {
    this.colours = colours;
    this.told = document.getElementById("probe");
    const map = (id, title) => new FieldMap(document.getElementById(id), title, (node, by) => this.probe(node, by));
    this.heights = map("picture", "Heights");
    this.contact = map("maps", "Contact");
    this.pressure = map("maps", "Pressure");
    this.gap = map("maps", "Gap");
  }

  /* The maps of a solution. */
  get ofSolution() {
    return [this.contact, this.pressure, this.gap];
  }

  /* Shows the heights of a surface. */
  showSurface({ heights, shape, lengths, unit, lowest, highest, mean }) {
    const length = unit ?? "";
    const colours = colouring.sequential(this.colours, [lowest - mean, highest - mean], length);
    this.heights.show({ values: heights, shape, lengths: lengths ?? shape, unit: length, colours });
    this.surface = { heights, shape, lengths: lengths ?? shape, length };
  }

  /* Shows a solution, with lengths and pressures in these units. */
  showSolution({ shape, lengths, fields, limits, extremes }, length, pressure) {
    const { missing, attractive, yielded } = this.colours;
    const classes = [WHITE, BLACK, missing, attractive, yielded].map((colour, k) => ({ name: CLASSES[k], colour }));
    const show = (map, values, colours) => map.show({ values, shape, lengths, unit: length, colours });
    show(this.contact, fields.contact, colouring.classes(classes));
    show(this.pressure, fields.pressure, colouring.diverging(this.colours, limits.pressure, pressure));
    show(this.gap, fields.gap, colouring.sequential(this.colours, extremes.gap, length));
    this.solution = { shape, lengths, length, pressure, fields };
    this.probe(this.node);
  }

  /* Reads all maps at a node; those of another shape have another one there. */
  probe(node, by = "pointer") {
    this.node = node;
    const { surface, solution } = this;
    const { shape, lengths, length } = solution ?? surface;
    const isSame = other => String(other) === String(shape);
    for (const map of [this.heights, ...this.ofSolution]) map.mark(node && isSame(map.shape) ? node : null);
    this.told.setAttribute("aria-live", by === "keys" ? "polite" : "off");
    this.told.textContent = "";
    if (!node || node.some((k, axis) => k >= shape[axis])) return;
    const place = node[0] * shape[1] + node[1];
    const [x, y] = node.map((k, axis) => read((k * lengths[axis]) / shape[axis], length));
    const told = isSame(surface.shape) ? [`height ${read(surface.heights[place], surface.length)}`] : [];
    if (solution) {
      const { contact, pressure, gap } = solution.fields;
      told.push(`gap ${read(gap[place], length)}`, `pressure ${read(pressure[place], solution.pressure)}`);
      told.push(CLASSES[contact[place]]);
    }
    this.told.textContent = `x ${x}, y ${y}: ${told.join(", ")}`;
  }
}
