/* A measured curve, as text: two numbers on a line. */

import { typed } from "./quantity.js";

/* A unit in brackets. */
const UNIT = /[([]\s*([fpnuµmkMGT]?(?:m|Pa|N))\s*[)\]]/g;

/* The points of a curve. Lines on top that are no numbers are a heading, whose units in brackets are those of the
   numbers. Commas are decimal where semicolons or tabs separate. */
export function points(text) {
  const lines = text.split(/\r?\n/).filter(line => line.trim());
  const numbers = line => {
    const cells = /[;\t]/.test(line) ? line.replaceAll(",", ".").split(/[;\t]/) : line.trim().split(/[\s,]+/);
    const [x, y] = cells.filter(Boolean).map(Number);
    return Number.isFinite(x) && Number.isFinite(y) ? [x, y] : null;
  };
  const first = lines.findIndex(numbers);
  const heading = lines.slice(0, Math.max(first, 0)).join(" ");
  const [x, y] = [...heading.matchAll(UNIT)].map(([, unit]) => typed(`1${unit}`).value);
  return lines.slice(first).map(line => {
    const found = numbers(line);
    if (!found) throw new Error(`“${line.trim().slice(0, 40)}” is no point of the curve: give two numbers on a line`);
    return [found[0] * (x ?? 1), found[1] * (y ?? 1)];
  });
}
