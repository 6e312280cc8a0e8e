/* The maps as one picture, to be saved. */

import { scaleBar } from "./zoom.js";

const SIDE = 512,
  MARGIN = 24,
  LINE = 22;

/* A PNG of maps side by side, each with its title, scale and key, and a line of text below. */
export async function picture(maps, text) {
  const shown = maps.map(map => ({ map, width: SIDE, height: Math.round(SIDE / map.aspect) }));
  const height = Math.max(...shown.map(({ height }) => height));
  const canvas = document.createElement("canvas"),
    context = canvas.getContext("2d");
  canvas.width = MARGIN + shown.length * (SIDE + MARGIN);
  canvas.height = 2 * MARGIN + LINE + height + 2.5 * LINE;
  context.fillStyle = "#fff";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.font = '16px Arimo, "Liberation Sans", Arial, Helvetica, sans-serif';
  context.textBaseline = "middle";
  const write = (text, x, y, align = "left") => {
    [context.fillStyle, context.textAlign] = ["#111", align];
    context.fillText(text, x, y);
  };
  shown.forEach(({ map, width, height }, k) => {
    const left = MARGIN + k * (SIDE + MARGIN),
      top = MARGIN + LINE,
      below = top + height + 0.7 * LINE;
    write(map.title, left, MARGIN + 0.3 * LINE);
    context.imageSmoothingEnabled = map.canvas.width > SIDE;
    context.drawImage(map.canvas, left, top, width, height);
    context.strokeStyle = "#8a8a8a";
    context.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
    drawScale(context, scaleBar(map.zoom.length, map.zoom.unit), left + 12, top + height - 12, width, write);
    drawKey(context, map.entries, left, below, width, write);
  });
  write(text, MARGIN, canvas.height - 0.8 * LINE);
  const blob = await new Promise(done => canvas.toBlob(done, "image/png"));
  return { name: "contact.png", type: blob.type, bytes: await blob.arrayBuffer() };
}

/* The bar of a length, on white. */
function drawScale(context, { share, text }, left, bottom, width, write) {
  const wide = share * width;
  context.fillStyle = "#fffc";
  context.fillRect(left, bottom - LINE, wide, LINE);
  context.fillStyle = "#111";
  context.fillRect(left, bottom - 2, wide, 2);
  for (const x of [left, left + wide - 2]) context.fillRect(x, bottom - LINE, 2, LINE);
  write(text, left + wide / 2, bottom - LINE / 2, "center");
}

/* The names of classes, or the ends of scales. */
function drawKey(context, entries, left, y, width, write) {
  const wide = width / entries.length;
  entries.forEach(({ name, colour, low, high, colours }, k) => {
    const x = left + k * wide;
    const box = (x, wide, fill) => {
      context.fillStyle = fill;
      context.fillRect(x, y - 7, wide, 14);
    };
    if (name) {
      box(x, 14, "#8a8a8a");
      box(x + 1, 12, colour);
      return write(name, x + 20, y);
    }
    const from = x + context.measureText(low).width + 8,
      to = x + wide - context.measureText(high).width - 16;
    colours.forEach((colour, n) =>
      box(from + (n * (to - from)) / colours.length, (to - from) / colours.length + 1, colour),
    );
    write(low, x, y);
    write(high, to + 8, y);
  });
}
