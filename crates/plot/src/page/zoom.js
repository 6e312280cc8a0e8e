/* The part of a map that is shown, and the bar of its scale. */

import { read } from "./quantity.js";

const made = (name, className, content) =>
  Object.assign(document.createElement(name), { className, textContent: content });

/* The longest of 1, 2, 5, 10, … that takes at most a quarter of a length, and its text. */
export function scaleBar(length, unit) {
  const most = 0.25 * length,
    power = 10 ** Math.floor(Math.log10(most));
  const nice = [5, 2, 1].find(step => step * power <= most * (1 + 1e-9)) * power;
  return { share: nice / length, text: read(nice, unit) };
}

/* The wheel, the `buttons` and the keys + - 0 zoom what an `area` shows, dragging moves it, a double click shows all of it
   again. What is shown whole lets the page scroll: under the wheel, which has nothing to zoom out, and under a finger. */
export class Zoom {
  /* `onshow([x, y], share)` shows a part: its corner at the upper left and its sides, as shares of those of the whole. */
  constructor(area, onshow) {
    Object.assign(this, { area, onshow, corner: [0, 0], share: 1, bar: made("div", "scale", "") });
    const all = () => this.show(1);
    const ways = [
      ["+", "+", "zoom in", () => this.by(1.5)],
      ["-", "−", "zoom out", () => this.by(1 / 1.5)],
      ["0", "all", "show all", all],
    ];
    this.buttons = made("div", "zoom", "");
    for (const [, text, title, onclick] of ways) {
      this.buttons.append(Object.assign(made("button", "", text), { type: "button", title, onclick }));
    }
    const shares = (x, y) => [x / area.getBoundingClientRect().width, y / area.getBoundingClientRect().height];
    area.addEventListener(
      "wheel",
      event => {
        if (event.deltaY > 0 && this.share >= 1) return;
        event.preventDefault();
        const { x, y } = area.getBoundingClientRect();
        this.by(event.deltaY < 0 ? 1.25 : 0.8, shares(event.clientX - x, event.clientY - y));
      },
      { passive: false },
    );
    area.addEventListener("pointerdown", event => area.setPointerCapture(event.pointerId));
    area.addEventListener("pointermove", event => {
      if (event.buttons) this.show(this.share, shares(-event.movementX, -event.movementY), this.share);
    });
    area.addEventListener("dblclick", all);
    for (const place of [area, this.buttons]) {
      place.addEventListener("keydown", event => ways.find(([key]) => key === event.key)?.[3]());
    }
    area.tabIndex = 0;
  }

  /* Zooms; the point under a place of the area, in shares of its sides, stays where it is. */
  by(factor, place = [0.5, 0.5]) {
    const share = Math.min(1, Math.max(1 / 50, this.share / factor));
    this.show(share, place, this.share - share);
  }

  /* Shows a part; its corner moves by so much of a way. */
  show(share, way = [0, 0], much = 0) {
    this.corner = this.corner.map((at, k) => Math.min(Math.max(at + much * way[k], 0), 1 - share));
    this.share = share;
    this.area.parentElement.classList.toggle("zoomed", share < 1);
    this.measure(this.length, this.unit);
    this.onshow(this.corner, share);
  }

  /* Fits the bar to the length and the unit of the width of the whole. */
  measure(length, unit) {
    [this.length, this.unit] = [length, unit];
    const { share, text } = scaleBar(this.share * length, unit);
    this.bar.hidden = !Number.isFinite(share);
    this.bar.style.width = `${(100 * share).toFixed(2)}%`;
    this.bar.textContent = text;
  }
}
