/* The charts of the page, as the engine draws them. */

const AREA = { y_label: "contact fraction", y_unit: "%" };

/* The error function, to 2e-7 (M. Abramowitz and I. A. Stegun, 7.1.26). */
function erf(x) {
  const t = 1 / (1 + 0.3275911 * x);
  const series = [1.061405429, -1.453152027, 1.421413741, -0.284496736, 0.254829592];
  return 1 - series.reduce((sum, factor) => (sum + factor) * t, 0) * Math.exp(-x * x);
}

/* Persson's contact fraction under a pressure, in rms slopes times the contact modulus. */
export const persson = pressure => erf(Math.SQRT2 * pressure);

/* A state as a point of the curve of the area. */
const point = ({ mean_pressure: pressure, contact_fraction: fraction }) => [pressure, 100 * fraction];

/* So many loads from the lightest to the heaviest, evenly on a logarithmic axis. */
export const loads = ([low, high], count) =>
  Array.from({ length: count }, (_, k) => low * (high / low) ** (k / (count - 1)));

/* The contact area over the loads that have been solved: a curve of the settings as they are, the path of loading from the
   last of their states, and a curve of the settings before. */
export class Curves {
  constructor() {
    this.forget();
  }

  forget() {
    [this.now, this.path, this.before] = [new Map(), new Map(), new Map()];
  }

  /* Begins another curve, of settings of this name; `theory` is the rms slope times the contact modulus where Persson's
     theory holds, and `range` the loads to draw it for. */
  begin(name, theory, range) {
    this.dashes = theory ? loads(range, 60).map(load => [load, 100 * persson(load / theory)]) : [];
    if (name === this.name) return;
    this.name = name;
    if (this.now.size) [this.now, this.before] = [new Map(), this.now];
  }

  /* Adds a state. */
  add(state) {
    this.unit = state.pressure_unit;
    this.now.set(...point(state));
    this.path.clear();
  }

  /* Adds a state to the path of loading from another one. */
  follow(...states) {
    states.forEach(state => this.path.set(...point(state)));
  }

  chart() {
    const sorted = points => [...points].sort(([a], [b]) => a - b);
    const curves = [
      ["now", sorted(this.now)],
      ["before the last change", sorted(this.before)],
      ["under more load", sorted(this.path)],
    ].filter(([, points]) => points.length);
    if (curves.length === 1) curves[0][0] = "";
    const x_log = curves.every(([, points]) => points[0][0] > 0);
    const jumps = this.dashes.slice(1).map((point, k) => [this.dashes[k], point]);
    return { ...AREA, x_label: "mean pressure", x_unit: this.unit, x_log, curves, jumps };
  }
}

/* The distribution of a quantity over the nodes, as shares of those that have it. */
export function distribution({ curve, beyond }, x_label, x_unit, y_label) {
  return { caption: beyond, x_label, x_unit, y_label, y_unit: "%", curves: [["", curve]] };
}

/* The power spectral density of a surface, averaged over directions; its wave numbers in 1/µm rather than 1/m. */
export function spectrum({ wave_numbers, densities }, unit) {
  const scale = unit === "m" ? 1e-6 : 1;
  // what is below is rounding
  const least = 1e-12 * Math.max(...densities);
  const points = wave_numbers
    .map((wave, k) => [scale * wave, densities[k]])
    .filter(([wave, density]) => wave > 0 && density > least);
  return {
    x_label: "wave number",
    x_unit: unit && `1/${unit === "m" ? "µm" : unit}`,
    x_log: true,
    y_label: "spectral density",
    y_unit: unit && `${unit}⁴`,
    y_log: true,
    curves: [["", points]],
  };
}

/* A loop of approach and withdrawal: pressure over mean gap, or force over approach, broken where the state jumps; and a
   measured curve. */
export function loop(rows, isFree, units, measured) {
  const [x, y] = isFree ? ["approach", "normal_force"] : ["mean_gap", "mean_pressure"];
  const curves = new Map(),
    jumps = [];
  let last = null;
  for (const row of rows) {
    const point = [row[x], row[y]],
      name = row.direction === "withdrawal" ? "withdrawal" : "approach";
    if (!curves.has(name)) curves.set(name, last ? [last] : []);
    if (row.energy_drop > 0 && last) {
      jumps.push([last, point]);
      curves.get(name).push([NaN, NaN]);
    }
    curves.get(name).push(point);
    last = point;
  }
  return {
    x_label: x.replace("_", " "),
    x_unit: units.length,
    y_label: y.replace("_", " "),
    y_unit: isFree ? units.force : units.pressure,
    curves: [...curves, ["measured", measured]].filter(([, points]) => points.length),
    jumps,
  };
}
