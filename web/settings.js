/* The settings: what the form asks for, in the words of the engine, and the places of its faults. */

import { own } from "./controls.js";
import { word } from "./glossary.js";
import { take } from "./link.js";
import { read, typed, written } from "./quantity.js";

/* The parameters of laws: their names, and the quantities to begin with. */
const PARAMETERS = {
  work_of_adhesion: ["Work of adhesion w", "50mJ/m2"],
  range: ["Range ρ", "2nm"],
  exponent: ["Exponent n", "3"],
  hamaker: ["Hamaker’s constant A", "1e-19J"],
};

/* What need not be said. */
const DEFAULTS = { boundary: "periodic", law: "none", precision: "f64" };

/* The inputs of a file by which it is read once more. */
const OF_READING = ["channel", "masked"];

/* What a key without an input of its own belongs to. */
const PLACES = {
  load: ["mean_pressure", "mean_gap", "normal_force", "approach"],
  cycle: ["mean_gaps", "approaches", "steps"],
  lengths: ["Lx", "Ly"],
  make: ["rms_slope", "rms_height", "hurst", "k_l", "k_r", "k_s", "seed", "size", "shape"],
  prepare: ["align_rows", "remove_scars", "despike", "remove_form", "detrend", "fill", "window", "mirror", "resample"],
};

/* The nodes along y of a map that gets so many along x. */
const resampled = (nodes, [nx, ny]) => [nodes, Math.max(1, Math.round((nodes * ny) / nx))];

export class Settings {
  /* `onchange(what)` is called with what has changed: "surface", "steps" or "scene". */
  constructor(form, laws, onchange) {
    this.form = form;
    this.laws = laws.filter(({ needs }) => !needs.includes("law_table"));
    form.law.replaceChildren(...this.laws.map(({ name }) => new Option(name)));
    this.chooseLaw();
    this.show();
    form.addEventListener("submit", event => event.preventDefault());
    form.addEventListener("input", ({ target }) => {
      if (target.dataset.for) this.slide(target);
      if (target.name === "law") this.chooseLaw();
      this.show();
      // a text is complete when it is left or entered
      if (target.matches("input.quantity, [type=number]")) return;
      this.changed(target, onchange);
    });
    // as `asperity prepare --clean`, with parts to be left out
    const clean = form.querySelector("#clean");
    clean.addEventListener("click", () => {
      [form.align_rows.value, form.detrend.value, form.holes.value] = ["median", "plane", "fill"];
      form.remove_scars.checked = form.despike.checked = true;
      this.changed(clean, onchange);
    });
    form.addEventListener("change", ({ target }) => {
      if (target.matches("input.quantity, [type=number]")) this.changed(target, onchange);
    });
  }

  changed(input, onchange) {
    const isStep = input.closest("[data-form=file]") && !OF_READING.includes(input.name);
    onchange(isStep ? "steps" : input.closest("#surface") ? "surface" : "scene");
  }

  value(name) {
    const input = this.form[name];
    return input.type === "checkbox" ? input.checked : input.value.trim();
  }

  get isFile() {
    return this.value("form") === "file";
  }

  /* Whether a half-space that neither yields nor sticks is pressed, the same again beyond the map. */
  get isPlain() {
    const plain = { boundary: "periodic", body: "half-space", hardness: "", law: "none" };
    return Object.keys(plain).every(name => this.value(name) === plain[name]) && !this.scene().absent_missing;
  }

  /* How a file is read: the number of its channel, and whether masked points are missing. */
  get reading() {
    return { channel: this.value("channel") || undefined, masked: this.value("masked") };
  }

  /* Takes the settings of a link. */
  takeLink(link) {
    take(link, ["law"]);
    this.chooseLaw();
    take(link);
    this.show();
  }

  /* Turns to a file that is opened. */
  takeFile(name) {
    const { form } = this;
    form.querySelector("option[value=file]").hidden = false;
    form.form.value = "file";
    document.getElementById("opened").textContent = name;
    this.show();
  }

  /* Takes the channels of a file, none of whose steps is chosen. */
  takeChannels({ channels }) {
    const { form } = this;
    for (const input of form.querySelectorAll("[data-form=file] :is(input, select)")) {
      if (input.type === "checkbox") input.checked = false;
      else input.value = "";
    }
    form.channel.replaceChildren(...channels.map(text => new Option(text, text.split(":")[0])));
    form.channel.parentElement.hidden = channels.length < 2;
  }

  /* Takes what the map of a file has; its missing points are filled. */
  takeMap({ name, shape, lengths, unit, missing, unread }) {
    const { form } = this;
    form.masked.parentElement.hidden = !form.masked.checked && !unread.some(text => text.startsWith("a mask "));
    if (missing && !form.holes.value) form.holes.value = "fill";
    const told = [name, `${shape.join(" × ")} nodes`];
    if (lengths) told.push(lengths.map(side => read(side, unit ?? "")).join(" × "));
    if (missing) told.push(`${missing} missing points`);
    if (unread.length) told.push(`next to it ${unread.join(", ")}`);
    document.getElementById("opened").textContent = own(told.join(", "));
  }

  /* Chooses to take a plane off a map that is tilted; false if there is nothing to do. */
  takeWarnings(warnings) {
    const is = warnings.some(({ code }) => code === "tilt") && !this.value("detrend");
    if (is) this.form.detrend.value = "plane";
    return is;
  }

  /* Shows the inputs that belong to what is chosen, and the numbers of the sliders. */
  show() {
    const { form } = this,
      of = this.value("form"),
      size = Number(this.value("size"));
    for (const part of form.querySelectorAll("[data-form]")) {
      const which = part.dataset.form;
      part.hidden = which !== of && !(which === "made" && of !== "file");
    }
    for (const part of form.querySelectorAll("[data-body]"))
      part.hidden = !part.dataset.body.split(" ").includes(this.value("body"));
    form.k_s.max = size / 4;
    for (const slider of form.querySelectorAll("input[type=range][name]")) {
      slider.parentElement.querySelector(".number").textContent = this.number(slider);
    }
    for (const slider of form.querySelectorAll("[data-for]")) {
      const input = form[slider.dataset.for],
        side = typed(this.value(input.dataset.scale)),
        found = typed(input.value);
      if (side && found?.value > 0) slider.value = Math.log10(found.value / side.value);
    }
  }

  /* The number of a slider; of one for powers of ten to two digits. */
  number({ value, dataset }) {
    return "power" in dataset ? Number((10 ** value).toPrecision(2)) : Number(value);
  }

  /* A slider of a quantity, in powers of ten of another one. */
  slide(slider) {
    const input = this.form[slider.dataset.for],
      side = typed(this.value(input.dataset.scale));
    if (side) input.value = written(side.value * 10 ** slider.value, side.unit);
  }

  chooseLaw() {
    const law = this.laws.find(({ name }) => name === this.value("law"));
    const kept = new Map([...document.querySelectorAll("#parameters input")].map(input => [input.name, input.value]));
    this.kept = new Map([...(this.kept ?? []), ...kept]);
    const input = (name, text, value, hint = "") => {
      const label = document.createElement("label"),
        made = document.createElement("input");
      label.append(word(text), " ", made);
      Object.assign(made, { name, className: "quantity", placeholder: hint, spellcheck: false });
      made.defaultValue = value;
      made.value = this.kept.get(name) ?? value;
      return label;
    };
    const all = law.needs.map(name => input(name, ...PARAMETERS[name]));
    if (law.never_ends) all.push(input("cut_off", "Cut off at a gap of", "", "nowhere"));
    document.getElementById("parameters").replaceChildren(...all);
  }

  /* The parameters of a surface to be made. */
  made() {
    const form = this.value("form"),
      number = name => this.number(this.form[name]);
    const common = { form, size: Number(this.value("size")), lengths: this.value("made_lengths") };
    switch (form) {
      case "sphere":
        return { ...common, radius: this.value("radius") };
      case "wave":
        return { ...common, amplitude: this.value("amplitude"), periods: [number("periods_x"), number("periods_y")] };
      default:
        return {
          ...common,
          rms_slope: number("rms_slope"),
          hurst: number("hurst"),
          k_l: number("k_l"),
          k_s: number("k_s"),
          seed: Number(this.value("seed")),
        };
    }
  }

  /* The steps of the preparation of an opened map of this shape. */
  steps(shape) {
    const given = name => this.value(name) || undefined,
      edges = this.value("edges");
    const several = text => text?.split(/[\s,;×]+/);
    const mirrored = edges === "mirror" ? shape.map(n => (n === 1 ? 1 : 2 * n)) : shape;
    const nodes = Number(this.value("resample"));
    return {
      lengths: several(given("lengths")),
      unit: given("unit"),
      missing: several(given("missing"))?.map(Number),
      align_rows: given("align_rows"),
      remove_scars: given("remove_scars") && 0.667,
      despike: given("despike") && 10,
      remove_form: given("remove_form"),
      detrend: given("detrend"),
      fill: this.value("holes") === "fill" || undefined,
      mirror: edges === "mirror" || undefined,
      window: edges === "window" ? 0.1 : undefined,
      cut_off_wavelength: given("cut_off_wavelength"),
      resample: nodes ? resampled(nodes, mirrored) : undefined,
    };
  }

  /* Body, adhesion and solver. */
  scene() {
    const scene = {};
    const body = {
      "half-space": [],
      layer: ["layer", "poisson", "base"],
      coating: ["coating", "coating_modulus", "coating_poisson", "poisson"],
    };
    const names = ["modulus", "boundary", "hardness", "law", "precision", ...body[this.value("body")]];
    const law = [...document.querySelectorAll("#parameters input")].map(input => input.name);
    for (const name of [...names, ...law]) {
      const value = this.value(name);
      if (value !== "" && value !== DEFAULTS[name]) scene[name] = value;
    }
    // a sphere ends beyond its radius
    if (this.value("form") === "sphere" || (this.isFile && this.value("holes") === "absent"))
      scene.absent_missing = true;
    return scene;
  }

  /* Puts a sentence at the input that it names, or, if it is of a file or names none, at this place; false if that is
     not on the page. */
  static fault(message, otherwise, isOfFile) {
    const loads = /(mean|normal) (gap|pressure|force)/g;
    const words = isOfFile ? [] : (message.replace(loads, "$1_$2").match(/\w+/g) ?? []);
    const shown = element => element && !element.closest("[hidden]");
    const place = name => Object.keys(PLACES).find(place => PLACES[place].includes(name)) ?? name;
    const inputs = name => [`made_${name}`, name].map(name => document.getElementsByName(name)[0]);
    const outputs = name => [document.querySelector(`output[data-of="${name}"]`)];
    const at = name => [...outputs(name), ...inputs(name)].find(shown);
    const found = words.map(place).map(at).find(Boolean) ?? at(otherwise);
    if (!found) return false;
    const input = found.dataset.of === "load" ? document.getElementsByName("value")[0] : found;
    if (input.matches("input, select")) input.setAttribute("aria-invalid", "true");
    const output = found.matches("output") ? found : document.createElement("output");
    output.className = "error";
    output.textContent = message;
    if (output !== found) found.closest("label").after(output);
    return true;
  }

  static clearFaults() {
    for (const output of document.querySelectorAll("output.error")) {
      if (output.dataset.of) output.textContent = "";
      else output.remove();
    }
    for (const input of document.querySelectorAll("[aria-invalid]")) input.removeAttribute("aria-invalid");
  }
}
