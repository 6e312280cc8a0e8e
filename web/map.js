/* The map: a field on its rectangle, x to the right and y upwards, in the colours of the pictures. */

import { Zoom } from "./zoom.js";

const element = (name, className, parent) => {
  const made = document.createElement(name);
  made.className = className;
  parent?.append(made);
  return made;
};

const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;
const packed = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/* The colour of a share from 0 to 1 on a scale of 256. */
const shade = (scale, share) => {
  const at = 3 * Math.round(255 * Math.min(1, Math.max(0, share)));
  return scale.subarray(at, at + 3);
};

/* The colours along a part of a scale. */
const along = (scale, from, to) =>
  Array.from({ length: 33 }, (_, k) => css(shade(scale, from + ((to - from) * k) / 32)));

/* How values become colours: `index` of 256 that are packed in `table`, and the key of the map. */
export const colouring = {
  /* Classes by their number, with a name and a colour each; those without a name are not in the key. */
  classes: all => ({
    table: Uint32Array.from({ length: 256 }, (_, k) => packed(all[k]?.colour ?? [255, 255, 255])),
    index: value => value,
    key: found =>
      all.filter(({ name }, k) => name && found.has(k)).map(({ name, colour }) => ({ name, colour: css(colour) })),
  }),
  /* From the low end to the high one; both have a text. */
  sequential: (colours, [low, high], texts) =>
    scaled(colours.sequential, colours.missing, value => (value - low) / (high - low || 1), [[...texts, 0, 1]]),
  /* Zero in the middle, and a scale for each sign. */
  diverging: (colours, [low, high], texts) =>
    scaled(
      colours.diverging,
      colours.missing,
      value => 0.5 + 0.5 * (value < 0 ? value / (-low || Infinity) : value / (high || Infinity)),
      [low < 0 && [texts[0], "0", 0, 0.5], high > 0 && ["0", texts[1], 0.5, 1]].filter(Boolean),
    ),
};

const scaled = (scale, missing, share, ranges) => {
  // the last place is for values that are not finite
  const table = Uint32Array.from({ length: 256 }, (_, k) => packed(k < 255 ? shade(scale, k / 254) : missing));
  const index = value => (Number.isFinite(value) ? Math.round(254 * Math.min(1, Math.max(0, share(value)))) : 255);
  const key = () => ranges.map(([low, high, from, to]) => ({ low, high, colours: along(scale, from, to) }));
  return { table, index, key };
};

/* The keys that reach a node, by their steps along x and y. */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1], Enter: [0, 0] };

/* A line over the map, on white. */
const LINE = `<svg class="line" viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true"><path/><path/></svg>`;

export class FieldMap {
  /* `onprobe(node, by, press)` is called with the node under the pointer, or that the arrow keys reach; null where there
     is none. Where the map takes a line, a `press` begins it, or moves its end. */
  constructor(parent, title, onprobe) {
    this.figure = element("figure", "map", parent);
    this.title = title;
    const caption = element("figcaption", "", this.figure);
    this.field = element("div", "field", this.figure);
    this.field.setAttribute("role", "img");
    this.field.setAttribute("aria-label", `Map: ${title}. Arrow keys read it node by node.`);
    this.canvas = element("canvas", "", this.field);
    this.canvas.insertAdjacentHTML("afterend", LINE);
    this.line = this.canvas.nextSibling;
    this.cross = element("div", "cross", this.field);
    const under = event => {
      const { x, y, width, height } = this.canvas.getBoundingClientRect(),
        [nx, ny] = this.shape ?? [0, 0];
      const i = Math.floor(((event.clientX - x) / width) * nx),
        j = Math.floor((1 - (event.clientY - y) / height) * ny);
      const press = this.takesLine && event.buttons ? event.type : "";
      // a line is drawn, and what is shown does not move
      if (press === "pointermove") event.stopImmediatePropagation();
      onprobe(i >= 0 && j >= 0 && i < nx && j < ny ? [i, j] : null, "pointer", press);
    };
    this.field.addEventListener("pointermove", under);
    this.field.addEventListener("pointerdown", under);
    this.zoom = new Zoom(this.field, ([x, y], share) => {
      for (const shown of [this.canvas, this.line])
        shown.style.transform = `scale(${1 / share}) translate(${-100 * x}%, ${-100 * y}%)`;
      this.smooth();
      this.mark(this.node);
    });
    this.zoom.bar.hidden = this.cross.hidden = true;
    caption.append(title, this.zoom.buttons);
    this.field.append(this.zoom.bar);
    this.key = element("div", "key", this.figure);
    this.beyond = element("p", "hint", this.figure);
    this.node = null;
    this.field.addEventListener("pointerleave", event => event.pointerType === "mouse" && onprobe(null, "pointer"));
    this.field.addEventListener("keydown", event => {
      const way = WAYS[event.key];
      if (!way || !this.shape) return;
      event.preventDefault();
      const step = event.shiftKey ? 10 : 1,
        from = this.node ?? this.shape.map(n => n >> 1);
      onprobe(
        from.map((at, k) => Math.min(this.shape[k] - 1, Math.max(0, at + step * way[k]))),
        "keys",
        this.takesLine && (event.key === "Enter" ? "pointerdown" : "pointermove"),
      );
    });
  }

  /* Paints values of a shape, (nx, ny) with y the fastest; `beyond` is what the colours do not show, in words. */
  show({ values, shape: [nx, ny], lengths: [lx, ly], unit, colours, beyond = "" }) {
    this.shape = [nx, ny];
    this.beyond.textContent = beyond;
    const { canvas } = this;
    if (canvas.width !== nx || canvas.height !== ny) [canvas.width, canvas.height] = [nx, ny];
    const context = canvas.getContext("2d"),
      image = context.createImageData(nx, ny);
    const pixels = new Uint32Array(image.data.buffer),
      found = new Set();
    const { table, index } = colours;
    for (let j = 0, at = 0; j < ny; j++) {
      for (let i = 0, from = ny - 1 - j; i < nx; i++, at++, from += ny) pixels[at] = table[index(values[from])];
    }
    if (values instanceof Uint8Array) for (const value of values) found.add(value);
    context.putImageData(image, 0, 0);
    // up to 5 : 1, as the pictures
    this.aspect = Math.min(5, Math.max(0.2, ny === 1 ? 5 : lx / ly));
    canvas.style.aspectRatio = this.aspect;
    this.smooth();
    this.zoom.measure(lx, unit);
    this.entries = colours.key(found);
    this.key.replaceChildren(
      ...this.entries.map(entry => {
        const text = document.createElement("span");
        if (entry.name) {
          element("i", "", text).style.background = entry.colour;
          text.append(entry.name);
          return text;
        }
        // the bar above its ends
        text.className = "scaled";
        element("span", "ramp", text).style.background = `linear-gradient(to right, ${entry.colours.join(",")})`;
        text.append(...[entry.low, entry.high].map(end => Object.assign(document.createElement("span"), { textContent: end })));
        return text;
      }),
    );
  }

  /* Smooths the pixels where there are more than the screen has. */
  smooth() {
    const shown = this.zoom.share * this.canvas.width;
    this.canvas.style.imageRendering = shown > this.field.clientWidth * devicePixelRatio ? "auto" : "pixelated";
  }

  /* Draws a line between two places in shares of the sides, in the place of which it takes another one. */
  drawLine([x, y, to_x, to_y], takesLine) {
    this.takesLine = takesLine;
    this.field.style.touchAction = takesLine ? "none" : "";
    for (const path of this.line.children) path.setAttribute("d", `M${x} ${1 - y}L${to_x} ${1 - to_y}`);
  }

  /* Marks a node, or none. */
  mark(node) {
    this.node = node;
    this.cross.hidden = !node || !this.shape;
    if (this.cross.hidden) return;
    const { share } = this.zoom,
      [x, y] = this.zoom.corner;
    const [u, v] = node.map((at, k) => (at + 0.5) / this.shape[k]);
    this.cross.style.left = `${(100 * (u - x)) / share}%`;
    this.cross.style.top = `${(100 * (1 - v - y)) / share}%`;
  }
}
