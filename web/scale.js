/* Where the colours of a map end, and what is beyond. */

import { read } from "./quantity.js";

/* Whether a value is beyond an end, by more than the rounding of either. */
const isBeyond = (value, end) => value - end > 1e-5 * Math.abs(end);

/* The ends of a scale in words; an arrow leads to an extreme value beyond. */
export const told = ([low, high], [least, greatest], unit) => [
  isBeyond(-least, -low) ? `${read(least, unit)} ← ${read(low, unit)}` : read(low, unit),
  isBeyond(greatest, high) ? `${read(high, unit)} → ${read(greatest, unit)}` : read(high, unit),
];

/* The shares of tension and load that are carried beyond the ends of their scales, in words. */
export function loadBeyond(pressures, ends, unit) {
  const isBoth = ends[0] < 0 && ends[1] > 0;
  const load = (sign, end) =>
    pressures.reduce((sum, pressure) => sum + (isBeyond(sign * pressure, end) ? sign * pressure : 0), 0);
  const side = (sign, name, k) => {
    const share = (100 * load(sign, sign * ends[k])) / load(sign, 0);
    if (!ends[k] || !(share > 0)) return [];
    const percent = share < 0.1 ? "Less than 0.1" : Number(share.toPrecision(2));
    return `${percent} % of the ${isBoth ? name : "load"} is carried ${k ? "above" : "below"} ${read(ends[k], unit)}`;
  };
  return [side(-1, "tension", 0), side(1, "load", 1)].flat().join(", ");
}
