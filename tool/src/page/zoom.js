"use strict";
// The wheel, the buttons and the keys + - 0 zoom a map, dragging moves it, a double click shows all of it again. A map
// that is shown whole lets the page scroll: under the wheel, which has nothing to zoom out, and under a finger.
for (const figure of document.querySelectorAll("figure.map")) {
  const svg = figure.querySelector("svg"), box = svg.viewBox.baseVal;
  const all = [box.x, box.y, box.width, box.height];
  const show = (x, y, width, height) => {
    x = Math.min(Math.max(x, 0), all[2] - width);
    y = Math.min(Math.max(y, 0), all[3] - height);
    svg.setAttribute("viewBox", [x, y, width, height].join(" "));
    figure.classList.toggle("zoomed", width < all[2]);
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
  figure.append(bar);
  figure.tabIndex = 0;
  figure.addEventListener("keydown", event => actions[event.key]?.());
}
