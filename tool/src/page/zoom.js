"use strict";
// A length as it is read, with a prefix in metres.
const length = (value, unit) => {
  if (unit !== "m") return `${+value.toPrecision(3)} ${unit ?? ""}`.trim();
  const power = Math.min(3, Math.max(-12, 3 * Math.floor(Math.log10(Math.abs(value) || 1) / 3 + 1e-9)));
  return `${+(value / 10 ** power).toPrecision(3)} ${{ "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k" }[power]}m`;
};
// Reads a map under the pointer, where it is and by its colour what it shows, and has a bar for its scale.
const reader = (figure, svg) => {
  const { lengths: [lx, ly], unit, key } = JSON.parse(figure.dataset.map);
  const image = svg.querySelector("image"), output = document.createElement("output"), bar = document.createElement("div");
  bar.className = "scale";
  let pixels = null;
  if (image && ly > 0) {
    const copy = new Image();
    copy.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [copy.naturalWidth, copy.naturalHeight];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(copy, 0, 0);
      pixels = context;
    };
    copy.src = image.href.baseVal;
  }
  const at = event => {
    const area = image?.getBoundingClientRect();
    const [u, v] = area ? [(event.clientX - area.x) / area.width, (event.clientY - area.y) / area.height] : [-1, -1];
    if (!pixels || u < 0 || v < 0 || u >= 1 || v >= 1) return void (output.textContent = "");
    const { width, height } = pixels.canvas;
    const [r, g, b] = pixels.getImageData(Math.floor(u * width), Math.floor(v * height), 1, 1).data;
    const far = ([colour]) => (colour[0] - r) ** 2 + (colour[1] - g) ** 2 + (colour[2] - b) ** 2;
    const [, value] = key.reduce((best, entry) => (far(entry) < far(best) ? entry : best));
    output.textContent = `x ${length(u * lx, unit)}, y ${length((1 - v) * ly, unit)}: ${value}`;
  };
  // the longest of 1, 2, 5, 10, … that takes at most a quarter of what is shown
  const scale = share => {
    const most = 0.25 * share * lx, power = 10 ** Math.floor(Math.log10(most));
    const nice = [5, 2, 1].find(step => step * power <= most) * power;
    const whole = svg.viewBox.baseVal.width, wide = image ? image.width.baseVal.value : whole;
    bar.style.width = `${(100 * nice / lx * wide / (share * whole)).toFixed(2)}%`;
    bar.textContent = length(nice, unit);
  };
  svg.addEventListener("pointerleave", () => (output.textContent = ""));
  return { at, scale, output, bar };
};
// The wheel, the buttons and the keys + - 0 zoom a map, dragging moves it, a double click shows all of it again. A map
// that is shown whole lets the page scroll: under the wheel, which has nothing to zoom out, and under a finger.
for (const figure of document.querySelectorAll("figure.map")) {
  const svg = figure.querySelector("svg"), box = svg.viewBox.baseVal;
  const all = [box.x, box.y, box.width, box.height];
  const read = reader(figure, svg);
  const show = (x, y, width, height) => {
    x = Math.min(Math.max(x, 0), all[2] - width);
    y = Math.min(Math.max(y, 0), all[3] - height);
    svg.setAttribute("viewBox", [x, y, width, height].join(" "));
    figure.classList.toggle("zoomed", width < all[2]);
    read.scale(width / all[2]);
  };
  // the point of the picture under the pointer stays where it is
  const zoom = (factor, u, v) => {
    const width = Math.min(all[2], Math.max(all[2] / 50, box.width / factor)), height = width * all[3] / all[2];
    show(box.x + u * (box.width - width), box.y + v * (box.height - height), width, height);
  };
  svg.addEventListener("wheel", event => {
    if (event.deltaY > 0 && box.width >= all[2]) return;
    event.preventDefault();
    const place = svg.getBoundingClientRect();
    zoom(event.deltaY < 0 ? 1.25 : 0.8, (event.clientX - place.x) / place.width, (event.clientY - place.y) / place.height);
  }, { passive: false });
  svg.addEventListener("pointerdown", event => svg.setPointerCapture(event.pointerId));
  svg.addEventListener("pointermove", event => {
    if (event.buttons) {
      const scale = box.width / svg.getBoundingClientRect().width;
      show(box.x - scale * event.movementX, box.y - scale * event.movementY, box.width, box.height);
    }
    read.at(event);
  });
  svg.addEventListener("dblclick", () => show(...all));
  const actions = { "+": () => zoom(1.5, 0.5, 0.5), "-": () => zoom(1 / 1.5, 0.5, 0.5), "0": () => show(...all) };
  const bar = document.createElement("div");
  for (const [key, text, name] of [["+", "+", "zoom in"], ["-", "−", "zoom out"], ["0", "all", "show all"]]) {
    const button = document.createElement("button");
    button.textContent = text;
    button.title = name;
    button.addEventListener("click", actions[key]);
    bar.append(button);
  }
  bar.prepend(read.output);
  figure.append(bar, read.bar);
  figure.tabIndex = 0;
  figure.addEventListener("keydown", event => actions[event.key]?.());
}
