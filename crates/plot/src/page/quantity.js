/* Quantities as they are typed and read: a number, a prefix and a unit. */

const POWERS = { f: -15, p: -12, n: -9, u: -6, µ: -6, m: -3, "": 0, k: 3, M: 6, G: 9, T: 12 };
const TYPED = /^([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(?:([fpnuµmkMGT]?)(m|Pa|N|J|N\/m|J\/m2))?$/;

/* The value of a text in units without prefix, and this unit, "" if it has none; null of another text. The engine reads
   what is solved: this places sliders. */
export function typed(text) {
  const found = TYPED.exec(text.trim());
  return found && { value: Number(found[1]) * 10 ** POWERS[found[2] ?? ""], unit: found[3] ?? "" };
}

/* A value to so many digits, with the prefix of its unit that makes it readable, as parts. */
function parts(value, unit, digits) {
  const rounded = Number(value.toPrecision(digits));
  if (!["m", "Pa", "N", "J", "J/m²"].includes(unit) || rounded === 0 || !Number.isFinite(rounded))
    return [String(rounded), unit ?? ""];
  const power = Math.min(9, Math.max(-12, 3 * Math.floor(Math.log10(Math.abs(rounded)) / 3 + 1e-9)));
  const prefix = Object.keys(POWERS).find(name => POWERS[name] === power);
  return [String(Number((rounded / 10 ** power).toPrecision(digits))), prefix + unit];
}

/* A quantity as one types it: "12.5MPa". */
export const written = (value, unit, digits = 3) => parts(value, unit, digits).join("");

/* A quantity as one reads it: "12.5 µm". */
export const read = (value, unit, digits = 3) =>
  parts(value, unit, digits)
    .join(" ")
    .replace(/ u(?=m|Pa|N|J)/, " µ")
    .replace("-", "−")
    .trim();
