/* The maps of the page: zoomed, and read under the pointer by their colours. */

/* The pixels of an image, once they are there. */
async function pixelsOf(image) {
  const copy = new Image(),
    canvas = document.createElement("canvas");
  copy.src = image.href.baseVal;
  await copy.decode();
  [canvas.width, canvas.height] = [copy.naturalWidth, copy.naturalHeight];
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(copy, 0, 0);
  return context;
}

for (const figure of document.querySelectorAll("figure.map")) {
  const svg = figure.querySelector("svg"),
    image = svg.querySelector("image"),
    told = document.createElement("output");
  const { lengths, unit, key } = JSON.parse(figure.dataset.map);
  const { width, height } = svg.viewBox.baseVal,
    sides = [width, height];
  const zoom = new Zoom(svg, (corner, share) => {
    const box = [...corner.map((at, k) => at * sides[k]), share * width, share * height];
    svg.setAttribute("viewBox", box.join(" "));
  });
  zoom.measure((lengths[0] * width) / (image?.width.baseVal.value ?? width), unit);
  zoom.buttons.prepend(told);
  figure.append(zoom.buttons, zoom.bar);
  // a line is a curve, without colours to read
  if (!image || !lengths[1]) continue;
  let pixels = null;
  pixelsOf(image).then(found => (pixels = found));
  svg.addEventListener("pointermove", event => {
    const area = image.getBoundingClientRect();
    const [u, v] = [(event.clientX - area.x) / area.width, (event.clientY - area.y) / area.height];
    if (!pixels || u < 0 || v < 0 || u >= 1 || v >= 1) return void (told.textContent = "");
    const at = [Math.floor(u * pixels.canvas.width), Math.floor(v * pixels.canvas.height)];
    const found = pixels.getImageData(...at, 1, 1).data;
    const far = ([colour]) => colour.reduce((sum, part, k) => sum + (part - found[k]) ** 2, 0);
    const [, value] = key.reduce((best, entry) => (far(entry) < far(best) ? entry : best));
    told.textContent = `x ${read(u * lengths[0], unit)}, y ${read((1 - v) * lengths[1], unit)}: ${value}`;
  });
  svg.addEventListener("pointerleave", () => (told.textContent = ""));
}
