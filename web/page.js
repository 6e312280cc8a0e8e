/* The page: what is asked for goes to the engine, the newest of it alone, and what is found goes to the screen. */

import { Curves, distribution, loads, spectrum } from "./charts.js";
import { own } from "./controls.js";
import { Cycle } from "./cycle.js";
import { Engine } from "./engine.js";
import { files, takeAway } from "./files.js";
import { Fill } from "./fill.js";
import { explain } from "./glossary.js";
import { linked } from "./link.js";
import { Load } from "./load.js";
import { Maps } from "./maps.js";
import { picture } from "./picture.js";
import { Player } from "./play.js";
import { typed } from "./quantity.js";
import { Settings } from "./settings.js";
import { Undo } from "./undo.js";
import { figure, folded, list, table } from "./words.js";

const at = id => document.getElementById(id);
const status = text => (at("status").textContent = text);

/* The share of the original in the nodes of a mirrored map. */
const partOf = ({ original, shape }) => original.reduce((share, nodes, axis) => (share * nodes) / shape[axis], 1);

/* The rows of a summary that stand next to the maps. */
const FIGURES =
  "contact, corrected for its edge, mean pressure, mean gap, normal force, approach, certified error, time".split(", ");
const GRID_ERROR = "error of the grid";

/* What may be asked for, in the order in which it is done. */
const OF_SURFACE = ["surface", "steps"];
const AFTER_IT = ["scene", "solve", "cycle", "rest"];

/* The rest in milliseconds before what is on the page is kept. */
const RESTING = 300;

/* The size of the smallest text of a chart, in its points. */
const SMALLEST = 8;

/* The loads of the area that are filled in, on surfaces of at most so many nodes. */
const FILLED = 14,
  MOST_FILLED = 512 ** 2;

class Page {
  constructor(engine) {
    this.engine = engine;
    this.wanted = new Set();
    this.charts = new Map();
    this.curves = new Curves();
    this.maps = new Maps(engine.about.colours, () => {
      this.along();
      this.keep();
    });
    explain(at("line"));
    this.settings = new Settings(at("settings"), engine.about.laws, what => this.want(what));
    this.load = new Load(at("load"), () => {
      this.player.stop();
      this.want("solve");
    });
    this.player = new Player(at("play"), at("drag"), share => {
      this.load.to(share);
      return this.want("solve");
    });
    this.fill = new Fill(engine);
    this.undo = new Undo(at("undo"), this);
    this.legs = new Cycle(at("legs"), () => this.want("cycle"), this.chart.bind(this));
    at("version").textContent = `asperity ${engine.about.version}`;
    at("load").addEventListener("change", () => this.keep());
    const cancel = () => {
      this.wanted.clear();
      this.player.stop();
      if (this.work) engine.cancel();
    };
    at("cancel").addEventListener("click", cancel);
    document.addEventListener("keydown", event => event.key === "Escape" && cancel());
    at("forget").addEventListener("click", () => {
      this.curves.forget();
      this.chart("area");
    });
    at("large").addEventListener("click", () => this.large());
    document.addEventListener("fullscreenchange", () => document.fullscreenElement || this.large(false));
    const failed = error => this.failed(error);
    files(file => this.open(file).catch(failed));
    const kept = { "contact.png": () => this.picture(), "table.csv": () => this.table };
    takeAway(async file => kept[file]?.() ?? engine.download(file), failed);
    // what is behind # is a place on the page, or a link
    const there = () => (location.hash.includes("=") ? location.hash.slice(1) : "");
    addEventListener("resize", () => this.draw());
    addEventListener("hashchange", () => there() && this.take(there()));
    this.take(there());
  }

  /* The link to what is on the page, with the name of an opened map. */
  link() {
    return linked() + (this.settings.isFile ? `&map=${encodeURIComponent(this.file.name)}` : "");
  }

  /* Puts what a link has on the page, or if that is of a map that is not open, asks for this one. */
  take(link) {
    const given = new URLSearchParams(link);
    this.awaited = given.get("form") === "file" && given.get("map") !== this.file?.name ? link : null;
    this.settings.takeLink(this.awaited ? "" : link);
    // the load of the link
    this.form = this.settings.value("form");
    this.isOther = this.isFresh = false;
    this.want("surface");
  }

  /* Asks for something: at once, or when what runs has ended, and then as it is by then; returns when all is done. */
  want(what) {
    this.fill.stop();
    this.wanted.add(what);
    // a surface that was refused may not be passed over
    if (this.due) this.wanted.add(this.due);
    return (this.work ??= this.doAll());
  }

  async doAll() {
    document.body.classList.add("busy");
    at("cancel").disabled = false;
    while (this.wanted.size) await this.doNext();
    this.work = null;
    document.body.classList.remove("busy");
    at("cancel").disabled = true;
    at("progress").value = 0;
  }

  async doNext() {
    const next = [...OF_SURFACE, ...AFTER_IT].find(name => this.wanted.delete(name));
    const isOfSurface = OF_SURFACE.includes(next);
    if (next !== "rest") {
      Settings.clearFaults();
      at("failure").hidden = true;
    }
    try {
      await this[next]();
      if (isOfSurface) this.due = null;
    } catch (error) {
      if (isOfSurface) {
        this.due = next;
        AFTER_IT.forEach(name => this.wanted.delete(name));
      }
      this.failed(error, next);
    }
  }

  /* What was asked for is refused or cancelled: what is shown is not the answer to it. */
  failed(error, what) {
    this.player.stop();
    at("stage").classList.add("stale");
    if (error.name === "AbortError") return status("Cancelled. What is shown is what was found before.");
    status(this.load.found ? "What is shown is the contact before." : "There is no contact yet.");
    const place = { surface: this.settings.isFile ? "heights" : "make", steps: "prepare", solve: "load" }[what] ?? what;
    const told = own(error.message);
    if (!error.isOfThread && Settings.fault(told, place, error.isOfFile)) return;
    // keys in words
    at("failure").textContent = told.replace(/\b[a-z]+(_[a-z]+)+\b/g, key => key.replaceAll("_", " "));
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
    const read = reading =>
      engine.open(file.name, file.bytes, reading).catch(error => {
        throw Object.assign(error, { isOfFile: true });
      });
    let map = await read(file.isNew ? {} : settings.reading);
    // of several channels the first one
    if (!map.heights) map = { ...(await read({ channel: map.channels[0].split(":")[0] })), channels: map.channels };
    this.form = "file";
    this.measured = map;
    if (file.isNew) {
      file.isNew = false;
      settings.takeChannels(map);
      settings.takeMap({ ...map, name: file.name });
      this.isOther = this.isFresh = true;
      if (this.awaited && new URLSearchParams(this.awaited).get("map") === file.name) return this.take(this.awaited);
    } else {
      settings.takeMap({ ...map, name: file.name });
    }
    return this.steps();
  }

  /* The surface: the map after the steps of its preparation. */
  async steps() {
    const map = await this.engine.prepare(this.settings.steps(this.measured.shape));
    this.lines = map.log.map(([step, what]) => `${step}: ${what}`);
    list("steps", this.lines);
    return this.found(map);
  }

  /* Takes a surface, which may be one of another kind, and asks for its contact. */
  async found(map) {
    this.map = map;
    this.maps.showSurface(map);
    this.doubts = map.warnings.map(({ message }) => message);
    const away = this.awaited && new URLSearchParams(this.awaited).get("map");
    if (away) this.doubts.unshift(`This link needs the map ${away}, which is not part of it: open that map.`);
    list("doubts", this.doubts);
    if (!map.lengths) throw new Error("the file has no side lengths: type them, such as 20um, or 20um 10um");
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
    const length = modulus.unit && "m";
    const scale = length ? (typed(`1${map.unit ?? "m"}`)?.value ?? 1) : 1;
    const [lowest, highest] = [map.lowest, map.highest].map(height => scale * (height - map.mean));
    const boundary = settings.value("boundary");
    // a force is that on the original of a mirrored map
    const part = map.original && boundary === "periodic" ? partOf(map) : 1;
    const area = part * map.lengths[0] * (map.lengths[1] || 1) * scale ** 2;
    const surface = { lowest, highest, slope: this.slope, area, length, pressure: modulus.unit };
    this.load.fit(surface, modulus, boundary, this.isOther);
    this.legs.fit(surface, settings.scene().range, boundary, this.isOther);
    this.offer("table.csv", false);
    if (this.isOther) this.curves.forget();
    this.isOther = false;
    const isOfTheory = ["self-affine", "file"].includes(settings.value("form")) && settings.isPlain;
    const name = JSON.stringify([settings.made(), this.file?.name, settings.steps([1, 1]), settings.scene()]);
    this.curves.begin(name, isOfTheory && this.slope * modulus.value, this.load.ranges.mean_pressure.log);
    at("persson").hidden = !this.curves.dashes.length;
  }

  async solve() {
    const { settings, load } = this;
    if (!this.map?.lengths) return;
    const [asked] = Object.values(load.scene);
    const start = this.start ?? "last";
    this.start = null;
    status(`Solving at ${asked}`);
    const onprogress = ({ iteration, error, tolerance }) => {
      const [reached, wanted] = [error.toExponential(1), tolerance.toExponential(0)];
      at("progress").value = Math.min(1, Math.max(0, Math.log(error) / Math.log(tolerance)));
      status(`Solving at ${asked}: error ${reached} of ${wanted}, ${iteration} iterations`);
    };
    const scene = { ...settings.scene(), ...load.scene };
    // without adhesion nothing acts on nodes apart, whose pressures are rounding
    const pressure = scene.law ? "pressure" : "contact_pressure";
    const fields = ["contact", pressure, "gap"];
    const found = await this.engine.solve(scene, { start, fields, histograms: 60, onprogress });
    if (!found) return;
    for (const of of [found.fields, found.extremes]) of.pressure = of[pressure];
    if (this.isFresh && settings.takeWarnings(found.account.warnings)) {
      this.wanted.add("steps");
      this.isOther = true;
    } else {
      await this.show(found, asked);
    }
    this.isFresh = false;
  }

  async show(found, asked) {
    const { account, rows, shortfalls, started } = found;
    const { status: ended, iterations } = account;
    [this.length, this.pressure] = [found.unit ?? "", account.pressure_unit ?? ""];
    this.histograms = found.histograms;
    this.maps.showSolution(found, this.length, this.pressure);
    this.along();
    this.load.found = account;
    table("rows", rows);
    this.figures(rows, started);
    const warnings = account.warnings.map(({ message }) => message).filter(text => !this.doubts.includes(text));
    const count = list("warnings", [...shortfalls, ...warnings]);
    at("warned").hidden = !count;
    at("warned").textContent = count === 1 ? "1 warning" : `${count} warnings`;
    const from = started === "last" ? ", from the contact before" : "";
    const by = this.load.isChosen ? ", chosen by the page" : "";
    if (this.settings.isFile) list("steps", [...this.lines, ...(by ? [`load: ${asked}${by} for this surface`] : [])]);
    status(`${ended[0].toUpperCase()}${ended.slice(1)} at ${asked}${by}: ${iterations} iterations${from}`);
    at("stage").classList.remove("stale");
    this.curves.add(account);
    this.chart("area", this.curves.chart());
    performance.mark("contact");
    this.wanted.add("rest");
  }

  /* The figures at the maps. Coarser grids tell the error of the grid; a solve from the contact before has none,
     and neither has one on one grid alone. */
  figures(rows, started) {
    const known = [...FIGURES, GRID_ERROR].flatMap(name => rows.filter(row => row[0] === name));
    const entries = known.map(([name, text]) => figure(name, own(text)));
    if (started === "last" && !known.some(([name]) => name === GRID_ERROR)) {
      const find = Object.assign(document.createElement("button"), { type: "button", textContent: "find" });
      find.title = "Solves once more, by way of coarser grids";
      find.addEventListener("click", () => {
        this.start = "default";
        this.want("solve");
      });
      entries.push(figure(GRID_ERROR, find));
    } else if (!known.some(([name]) => name === GRID_ERROR)) {
      entries.push(figure(GRID_ERROR, "unknown: it is solved on one grid alone"));
    }
    at("figures").replaceChildren(...entries);
  }

  /* The charts along the line of the profile. */
  along() {
    const found = this.maps.along();
    for (const id of ["sides", "loads"]) this.chart(id, found?.[id]);
  }

  /* What may wait while the load is dragged. */
  async rest() {
    const { length, pressure, map } = this;
    const { gap, contact_pressure } = this.histograms;
    const { histogram, spectrum: found } = this.statistics;
    this.chart("pressures", distribution(contact_pressure, "contact pressure", pressure, "nodes in contact"));
    this.chart("gaps", distribution(gap, "gap", length, "nodes apart"));
    if (histogram) this.chart("heights", distribution(histogram, "height", map.unit, "nodes"));
    if (found) this.chart("spectrum", spectrum(found, map.unit));
    const { shell, python } = await this.engine.lines();
    [at("command").textContent, at("python").textContent] = [shell.map(folded).join("\n"), python];
    this.offer("start.npz", shell.join().includes("start.npz"));
    this.keep();
    if (!this.player.isOn) await this.fillArea();
  }

  /* Keeps what is on the page once it rests: in the address, and for the way back. */
  keep() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => {
      if (this.work) return;
      history.replaceState(null, "", `#${this.link()}`);
      at("link").textContent = location.href;
      this.undo.keep();
    }, RESTING);
  }

  /* Fills in the curve of the area while the page rests: with adhesion, where the area depends on the way to a load, by
     the path of loading from the state that is shown. */
  async fillArea() {
    const { settings, map, load, curves } = this;
    const [nx, ny] = map.shape;
    if (nx * ny > MOST_FILLED) return;
    const adheres = settings.value("law") !== "none";
    const known = adheres ? [load.found.mean_pressure] : [...curves.now.keys()];
    const pressures = loads(load.ranges.mean_pressure.log, FILLED).filter(
      value => !known.some(pressure => Math.abs(pressure / value - 1) < 0.1 || (adheres && value < pressure)),
    );
    const scene = settings.scene(),
      scenes = pressures.map(value => ({ ...scene, mean_pressure: `${value}${load.units.mean_pressure}` }));
    const gap = adheres ? await this.engine.gap() : null;
    if (this.wanted.size) return;
    const onfound = account => {
      if (adheres) curves.follow(load.found, account);
      else curves.add(account);
      this.chart("area", curves.chart());
    };
    this.fill.start(scenes, onfound, gap);
  }

  /* Turns to large type on the full screen, where there is one, or back. */
  large(is = !document.body.classList.contains("large")) {
    document.body.classList.toggle("large", is);
    at("large").setAttribute("aria-pressed", is);
    if (is) document.documentElement.requestFullscreen?.().catch(() => {});
    else if (document.fullscreenElement) document.exitFullscreen();
    this.draw();
  }

  /* Draws all charts again. */
  draw() {
    for (const [id, chart] of [...this.charts]) this.chart(id, chart);
  }

  /* Draws a chart as wide as its place, with text of three quarters of the page's; or none. */
  chart(id, chart) {
    this.charts.delete(id);
    if (!chart) return at(id).replaceChildren();
    this.charts.set(id, chart);
    const size = parseFloat(getComputedStyle(document.body).fontSize),
      width = Math.min(at(id).parentElement.clientWidth, 40 * size);
    at(id).innerHTML = this.engine.chart({ ...chart, width: (width * SMALLEST) / (0.75 * size) });
  }

  async cycle() {
    if (this.length === undefined) return;
    await this.legs.follow(this.engine, this.settings.scene(), row => {
      at("progress").value = row.share;
      status(`Following the cycle: ${row.count} states, ${row.direction}`);
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

  /* The maps as a picture, with the figures. */
  picture() {
    const told = [...at("figures").children].map(
      ({ children: [name, value] }) => `${name.textContent} ${value.textContent}`,
    );
    const { ofSolution, pressure } = this.maps;
    const all = [...told, pressure.beyond.textContent].filter(text => text && !text.endsWith(" find"));
    return picture(ofSolution, all.join(", "));
  }
}

try {
  new Page(await Engine.start());
} catch (error) {
  document.body.classList.remove("busy");
  status("");
  at("failure").textContent = `The solver does not start: ${error.message}`;
  at("failure").hidden = false;
}
