/* The maps of the page: heights, contact, pressure and gap, which are read together. */

import { FieldMap, colouring } from "./map.js";
import { Profile } from "./profile.js";
import { read } from "./quantity.js";
import { loadBeyond, told } from "./scale.js";

/* The classes of contact, by their numbers. */
const CLASSES = ["apart", "contact", "nothing there", "attractive", "yielded"];
/* The colours of nodes apart and in contact, on a light and on a dark page. */
const LIGHT = [
  [255, 255, 255],
  [0, 0, 0],
];
const DARK = [
  [31, 34, 38],
  [238, 238, 238],
];

/* The original of a mirrored field, which is its corner. */
const cropped = (values, ny, [mx, my]) =>
  Float32Array.from({ length: mx * my }, (_, k) => values[Math.floor(k / my) * ny + (k % my)]);

export class Maps {
  /* `online()` is called when the line of the profile is another one. */
  constructor(colours, online) {
    this.colours = colours;
    this.told = document.getElementById("probe");
    this.held = document.getElementsByName("held")[0];
    this.held.addEventListener("change", () => this.hold());
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.solution && this.paint());
    const map = (id, title) =>
      new FieldMap(document.getElementById(id), title, (node, by, press) => this.probe(node, by, press));
    this.heights = map("picture", "Heights");
    this.contact = map("maps", "Contact");
    this.pressure = map("maps", "Pressure");
    this.gap = map("maps", "Gap");
    this.profile = new Profile(document.getElementById("profile"), this.ofSolution, online);
  }

  /* The maps of a solution. */
  get ofSolution() {
    return [this.contact, this.pressure, this.gap];
  }

  /* Shows the heights of a surface, of a mirrored one those of the original. */
  showSurface({ heights, shape, original, lengths, unit, lowest, highest, limits, mean }) {
    const length = unit ?? "";
    const [extremes, range] = [[lowest, highest], limits].map(ends => ends.map(height => height - mean));
    const colours = colouring.sequential(this.colours, range, told(range, extremes, length));
    const part = original ?? shape,
      sides = (lengths ?? shape).map((side, axis) => (side * part[axis]) / shape[axis]);
    const values = original ? cropped(heights, shape[1], original) : heights;
    this.heights.show({ values, shape: part, lengths: sides, unit: length, colours });
    this.surface = { heights, shape, lengths: lengths ?? shape, length };
  }

  /* Shows a solution, with lengths and pressures in these units. */
  showSolution({ shape, lengths, fields, limits, extremes }, length, pressure) {
    // the least gap is the gap in contact
    this.limits = [...limits.pressure, extremes.gap[0], limits.gap[1]];
    this.solution = { shape, lengths, length, pressure, fields, extremes };
    this.paint();
    this.profile.show();
    this.probe(this.node);
  }

  /* The charts along the line of the profile; nothing without a solution. */
  along() {
    return this.solution && this.profile.charts(this.solution, this.surface);
  }

  /* Holds the ends of the colours as they are, in the value of the box, or lets them follow the solution. */
  hold() {
    if (!this.solution) return;
    this.held.value = this.limits.map(end => end.toPrecision(6)).join(" ");
    this.paint();
  }

  /* Paints the solution. */
  paint() {
    const { shape, lengths, length, pressure, fields, extremes } = this.solution;
    const { missing, attractive, yielded } = this.colours;
    const ground = this.dark.matches ? DARK : LIGHT;
    const classes = [...ground, missing, attractive, yielded].map((colour, k) => ({ name: CLASSES[k], colour }));
    const show = (map, values, colours, beyond) => map.show({ values, shape, lengths, unit: length, colours, beyond });
    const limits = this.held.checked ? this.held.value.split(" ").map(Number) : this.limits;
    const [pressures, gaps] = [limits.slice(0, 2), limits.slice(2)];
    const ofPressure = told(pressures, extremes.pressure, pressure),
      ofGap = told(gaps, extremes.gap, length);
    show(this.contact, fields.contact, colouring.classes(classes));
    const beyond = loadBeyond(fields.pressure, pressures, pressure);
    show(this.pressure, fields.pressure, colouring.diverging(this.colours, pressures, ofPressure), beyond);
    show(this.gap, fields.gap, colouring.sequential(this.colours, gaps, ofGap));
  }

  /* Reads all maps at a node, maps of another shape at another node; a `press` draws the line of the profile to it. */
  probe(node, by = "pointer", press = "") {
    this.node = node;
    const { surface, solution, profile } = this;
    if (press && node && solution && profile.isOn) profile.draw(node, solution.shape, press === "pointerdown");
    const { shape, lengths, length } = solution ?? surface;
    const isSame = other => String(other) === String(shape);
    for (const map of [this.heights, ...this.ofSolution]) map.mark(node && isSame(map.shape) ? node : null);
    this.told.setAttribute("aria-live", by === "keys" ? "polite" : "off");
    this.told.textContent = "";
    if (!node || node.some((k, axis) => k >= shape[axis])) return;
    const placed = ([, ny]) => node[0] * ny + node[1];
    const place = placed(shape);
    const [x, y] = node.map((k, axis) => read((k * lengths[axis]) / shape[axis], length));
    // a solution on the original of a mirrored map is of its corner
    const told = [`height ${read(surface.heights[placed(surface.shape)], surface.length)}`];
    if (solution) {
      const { contact, pressure, gap } = solution.fields;
      told.push(`gap ${read(gap[place], length)}`, `pressure ${read(pressure[place], solution.pressure)}`);
      told.push(CLASSES[contact[place]]);
    }
    this.told.textContent = `x ${x}, y ${y}: ${told.join(", ")}`;
  }
}
