/* The page: what is asked for goes to the engine, the newest of it alone, and what is found goes to the screen. */

import { Curves, distribution, spectrum } from "./charts.js";
import { Cycle } from "./cycle.js";
import { Engine } from "./engine.js";
import { files, takeAway } from "./files.js";
import { Load } from "./load.js";
import { FieldMap, colouring } from "./map.js";
import { picture } from "./picture.js";
import { read, typed } from "./quantity.js";
import { Settings } from "./settings.js";

const at = id => document.getElementById(id);

/* The rows of a summary that stand beside the maps. */
const GRID_ERROR = "error of the grid";
const FIGURES = ["contact", "corrected for its edge", "mean pressure", "mean gap", "normal force", "approach",
  "certified error", "time", GRID_ERROR];

/* What may be asked for, in the order in which it is done. */
const OF_SURFACE = ["surface", "steps"];
const ORDER = [...OF_SURFACE, "scene", "solve", "cycle", "rest"];

const status = text => (at("status").textContent = text);

/* Sentences as a list, which is hidden if there are none. */
const list = (id, sentences) => {
  at(id).replaceChildren(...sentences.map(text => Object.assign(document.createElement("li"), { textContent: text })));
  at(id).hidden = !sentences.length;
};

const table = (id, rows) => at(id).replaceChildren(...rows.map(([name, text]) => {
  const row = document.createElement("tr"), head = document.createElement("th"), cell = document.createElement("td");
  [head.scope, head.textContent, cell.textContent] = ["row", name, text];
  row.append(head, cell);
  return row;
}));

/* A command on lines of some eighty characters; one with quoted words stays as it is. */
const folded = command => /['"\\]/.test(command) ? command : command.split(/ (?=--)/).reduce((lines, option) => {
  const before = lines.slice(lines.lastIndexOf("\n") + 1);
  return before.length + option.length > 78 ? `${lines} \\\n    ${option}` : `${lines} ${option}`;
});

/* A figure under its name. */
const figure = (name, content) => {
  const entry = document.createElement("div"), term = document.createElement("dt"), value = document.createElement("dd");
  term.textContent = name;
  value.append(content);
  entry.append(term, value);
  return entry;
};

class Page {
  constructor(engine) {
    this.engine = engine;
    this.wanted = new Set();
    this.curves = new Curves();
    const probe = (node, by) => this.probe(node, by);
    const map = title => new FieldMap(at("maps"), title, probe);
    this.maps = { contact: map("Contact"), pressure: map("Pressure"), gap: map("Gap") };
    this.heights = new FieldMap(at("picture"), "Heights", probe);
    this.settings = new Settings(at("settings"), engine.about.laws, what => this.want(what));
    this.load = new Load(at("load"), () => this.want("solve"));
    at("version").textContent = `asperity ${engine.about.version}`;
    const cancel = () => {
      this.wanted.clear();
      if (this.isBusy) engine.cancel();
    };
    at("cancel").addEventListener("click", cancel);
    document.addEventListener("keydown", event => event.key === "Escape" && cancel());
    this.legs = new Cycle(at("legs"), () => this.want("cycle"), (id, chart) => this.chart(id, chart));
    at("forget").addEventListener("click", () => {
      this.curves.forget();
      at("area").replaceChildren();
    });
    files(file => this.open(file).catch(error => this.failed(error)));
    const told = () => [...at("figures").children].map(entry => [...entry.children].map(part => part.textContent).join(" "));
    const kept = { "contact.png": () => picture(Object.values(this.maps), told().join(", ")), "table.csv": () => this.table };
    takeAway(async file => kept[file]?.() ?? engine.download(file), error => this.failed(error));
    this.want("surface");
  }

  /* Asks for something: at once, or when what runs has ended, and then as it is by then. */
  async want(what) {
    this.wanted.add(what);
    // what was refused may not be passed over
    if (this.due) this.wanted.add(this.due);
    if (this.isBusy) return;
    this.isBusy = true;
    document.body.classList.add("busy");
    at("cancel").disabled = false;
    while (this.wanted.size) {
      const next = ORDER.find(name => this.wanted.delete(name));
      try {
        if (next !== "rest") this.clear();
        await this[next]();
        if (OF_SURFACE.includes(next)) this.due = null;
      } catch (error) {
        if (OF_SURFACE.includes(next)) {
          this.due = next;
          // there is no surface to solve on
          ORDER.filter(name => !OF_SURFACE.includes(name)).forEach(name => this.wanted.delete(name));
        }
        this.failed(error, next);
      }
    }
    this.isBusy = false;
    document.body.classList.remove("busy");
    at("cancel").disabled = true;
    at("progress").value = 0;
  }

  /* Forgets what was wrong with what was asked for before. */
  clear() {
    Settings.clearFaults();
    at("failure").hidden = true;
  }

  /* What was asked for is refused or cancelled: what is shown is not the answer to it. */
  failed(error, what) {
    at("stage").classList.add("stale");
    if (error.name === "AbortError") return status("Cancelled. What is shown is what was found before.");
    status("What is shown is the contact before.");
    const place = { surface: this.settings.isFile ? "heights" : "make", steps: "prepare", solve: "load" }[what] ?? what;
    if (Settings.fault(error.message, place, error.isOfFile)) return;
    at("failure").textContent = error.message;
    at("failure").hidden = false;
  }

  async open(file) {
    this.file = { name: file.name, bytes: await file.arrayBuffer(), isNew: true };
    this.settings.takeFile(file.name);
    this.want("surface");
  }

  /* The map: as it was measured, or made. */
  async surface() {
    const { engine, settings, file } = this;
    this.wanted.delete("steps");
    status("Reading the surface");
    if (!settings.isFile) {
      const made = settings.made();
      this.isOther ||= made.form !== this.form;
      const map = await engine.make(made);
      this.form = made.form;
      return this.found(map);
    }
    const read = channel => engine.open(file.name, file.bytes, { channel }).catch(error => {
      throw Object.assign(error, { isOfFile: true });
    });
    let map = await read(file.isNew ? undefined : settings.channel);
    // of several channels the first one
    if (!map.heights) map = { ...await read(map.channels[0].split(":")[0]), channels: map.channels };
    this.form = "file";
    if (file.isNew) settings.takeMap(map);
    this.measured = map;
    if (file.isNew) this.isOther = this.isFresh = true;
    file.isNew = false;
    return this.steps();
  }

  /* The surface: the map after the steps of its preparation. */
  async steps() {
    const { engine, settings, measured } = this;
    const map = await engine.prepare(settings.steps(measured.shape));
    list("steps", map.log.map(([step, what]) => `${step}: ${what}`));
    return this.found(map);
  }

  /* Takes a surface, which may be one of another kind, and asks for its contact. */
  async found(map) {
    const { colours } = this.engine.about;
    const lengths = map.lengths ?? map.shape;
    this.heights.show({
      values: map.heights, shape: map.shape, lengths, unit: map.unit ?? "",
      colours: colouring.sequential(colours, [map.lowest - map.mean, map.highest - map.mean], map.unit ?? ""),
    });
    list("doubts", map.warnings.map(({ message }) => message));
    this.map = map;
    if (!map.lengths) throw new Error("the file has no side lengths: type them, as 20um, or 20um 10um");
    this.statistics = await this.engine.statistics();
    // of a map with missing points there are none
    const { figures, rows } = this.statistics;
    table("statistics", rows ?? []);
    this.slope = figures?.rms_slope ?? figures?.rms_slope_differences;
    this.wanted.add("scene");
  }

  /* Fits the loads to surface and body. */
  scene() {
    const { map, settings } = this;
    if (!map?.lengths) return;
    this.wanted.add("solve");
    const modulus = typed(settings.value("modulus"));
    // the engine says what is wrong with it
    if (!(modulus?.value > 0)) return;
    // lengths in metres where they have units
    const scale = modulus.unit ? typed(`1${map.unit ?? "m"}`)?.value ?? 1 : 1, length = modulus.unit && "m";
    const [lowest, highest] = [map.lowest, map.highest].map(height => scale * (height - map.mean));
    const area = map.lengths[0] * (map.lengths[1] || 1) * scale ** 2, boundary = settings.value("boundary");
    const surface = { lowest, highest, slope: this.slope, area, length };
    this.load.fit(surface, modulus, boundary, this.isOther);
    this.legs.fit(surface, settings.scene().range, boundary, this.isOther);
    this.offer("table.csv", false);
    if (this.isOther) this.curves.forget();
    this.isOther = false;
    this.curves.begin(JSON.stringify([settings.made(), this.file?.name, settings.steps([1, 1]), settings.scene()]));
  }

  async solve() {
    const { settings } = this;
    if (!this.map?.lengths) return;
    const asked = Object.values(this.load.scene)[0], start = this.start ?? "last";
    this.start = null;
    status(`Solving at ${asked}`);
    const found = await this.engine.solve({ ...settings.scene(), ...this.load.scene }, {
      start, fields: ["contact", "pressure", "gap"], histograms: 60,
      onprogress: ({ iteration, error, tolerance }) => {
        at("progress").value = Math.min(1, Math.max(0, Math.log(error) / Math.log(tolerance)));
        status(`Solving at ${asked}: error ${error.toExponential(1)} of ${tolerance.toExponential(0)}, ${iteration} iterations`);
      },
    });
    if (!found) return;
    if (this.isFresh && settings.takeWarnings(found.account.warnings)) {
      this.wanted.add("steps");
      this.isOther = true;
    } else {
      await this.show(found, asked);
    }
    this.isFresh = false;
  }

  async show({ account, rows, shortfalls, started, shape, lengths, unit, fields, limits, extremes, histograms }, asked) {
    const { about } = this.engine, { colours } = about, length = unit ?? "", pressure = account.pressure_unit ?? "";
    const classes = [{ name: "apart", colour: [255, 255, 255] }, { name: "contact", colour: [0, 0, 0] },
      { name: "nothing there", colour: colours.missing }, { name: "attractive", colour: colours.attractive },
      { name: "yielded", colour: colours.yielded }];
    const field = (values, colours) => ({ values, shape, lengths, unit: length, colours });
    this.maps.contact.show(field(fields.contact, colouring.classes(classes)));
    this.maps.pressure.show(field(fields.pressure, colouring.diverging(colours, limits.pressure, pressure)));
    this.maps.gap.show(field(fields.gap, colouring.sequential(colours, extremes.gap, length)));
    this.solution = { shape, lengths, length, pressure, fields };
    this.load.found = account;
    this.histograms = histograms;
    this.curves.add(account);
    table("rows", rows);
    this.figures(rows, started);
    const known = this.map.warnings.map(({ message }) => message);
    const warnings = [...shortfalls, ...account.warnings.map(({ message }) => message).filter(text => !known.includes(text))];
    list("warnings", warnings);
    at("stage").classList.remove("stale");
    this.probe(this.node);
    const from = started === "last" ? ", from the contact before" : "";
    status(`${account.status[0].toUpperCase()}${account.status.slice(1)} at ${asked}: ${account.iterations} iterations${from}`);
    at("warned").hidden = !warnings.length;
    at("warned").textContent = warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`;
    await this.chart("area", this.curves.chart());
    performance.mark("contact");
    this.wanted.add("rest");
  }

  /* The figures beside the maps. Coarser grids tell the error of the grid; a solve from the contact before has none. */
  figures(rows, started) {
    const entries = FIGURES.flatMap(name => rows.filter(row => row[0] === name)).map(([name, text]) => figure(name, text));
    if (started === "last" && !rows.some(([name]) => name === GRID_ERROR)) {
      const find = Object.assign(document.createElement("button"), { type: "button", textContent: "find" });
      find.title = "Solves once more, by way of coarser grids";
      find.addEventListener("click", () => {
        this.start = "default";
        this.want("solve");
      });
      entries.push(figure(GRID_ERROR, find));
    }
    at("figures").replaceChildren(...entries);
  }

  /* What may wait while the load is dragged. */
  async rest() {
    const { histograms: { gap, contact_pressure }, solution: { length, pressure }, statistics, map } = this;
    await this.chart("pressures", distribution(contact_pressure, "contact pressure", pressure, "nodes in contact"));
    await this.chart("gaps", distribution(gap, "gap", length, "nodes apart"));
    if (statistics.histogram) await this.chart("heights", distribution(statistics.histogram, "height", map.unit, "nodes"));
    if (statistics.spectrum) await this.chart("spectrum", spectrum(statistics.spectrum, map.unit));
    const { shell, python } = await this.engine.lines();
    [at("command").textContent, at("python").textContent] = [shell.map(folded).join("\n"), python];
    this.offer("start.npz", shell.join().includes("start.npz"));
  }

  async chart(id, chart) {
    at(id).innerHTML = await this.engine.chart({ title: "", ...chart });
  }

  async cycle() {
    if (!this.solution) return;
    const { length, pressure } = this.solution;
    await this.legs.follow(this.engine, this.settings.scene(), { length, pressure, force: length && "N" }, (count, row, share) => {
      at("progress").value = share ?? 0;
      status(`Following the cycle: ${count} states, ${row.direction}`);
    });
    this.table = await this.engine.download("table.csv");
    this.offer("table.csv", true);
    // the engine is at the end of the cycle: what is taken away is what is shown
    this.start = "default";
    this.wanted.add("solve");
  }

  /* Offers a file to take away, or no longer. */
  offer(file, is) {
    at("files").querySelector(`[data-file="${file}"]`).hidden = !is;
  }

  /* Reads all maps at a node. */
  probe(node, by = "pointer") {
    this.node = node;
    const { map, solution } = this, shape = this.solution?.shape ?? map?.shape;
    at("probe").setAttribute("aria-live", by === "keys" ? "polite" : "off");
    for (const shown of [...Object.values(this.maps), this.heights]) shown.mark(node && String(shown.shape) === String(shape) ? node : null);
    at("probe").textContent = "";
    if (!node || !shape || node.some((k, axis) => k >= shape[axis])) return;
    const at_ = node[0] * shape[1] + node[1];
    const lengths = solution?.lengths ?? map.lengths, length = solution?.length ?? map.unit ?? "";
    const [x, y] = node.map((k, axis) => read(k * lengths[axis] / shape[axis], length));
    const told = [];
    if (String(map.shape) === String(shape)) told.push(`height ${read(map.heights[at_], map.unit ?? "")}`);
    if (solution) {
      const { fields: { contact, pressure, gap } } = solution;
      told.push(`gap ${read(gap[at_], length)}`, `pressure ${read(pressure[at_], solution.pressure)}`,
        ["apart", "contact", "nothing there", "attractive", "yielded"][contact[at_]]);
    }
    at("probe").textContent = `x ${x}, y ${y}: ${told.join(", ")}`;
  }
}

try {
  new Page(await Engine.start());
} catch (error) {
  document.body.classList.remove("busy");
  status("");
  at("failure").textContent = `The solver does not start in this browser: ${error.message}`;
  at("failure").hidden = false;
}
