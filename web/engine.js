/* The engine as the page calls it: one call after the other, on the thread of `worker.js`.

   Keys are those of reports, as `work_of_adhesion`. Values are as they were typed: texts with units, as "70GPa", or
   numbers; what is empty counts as not given. Every call is a promise, refused with the sentence of the program. Fields
   are typed arrays, node (i, j) at index i ny + j, with i along x and j along y.

   A call that runs cannot be interrupted: to cancel, its thread is ended, and another one starts with the module that is
   compiled already and makes the surface again. So no shared memory is needed, which few hosts allow. */

import init, { about, chart } from "./asperity_web.js";

const MADE = ["open", "make", "prepare"];

export class Engine {
  /* Starts the engine: fetches and compiles the module, after which no network is needed. */
  static async start() {
    const url = new URL("asperity_web_bg.wasm", import.meta.url);
    const compiled = async () => {
      const response = await fetch(url);
      if (!response.ok) throw new Error(`${url.pathname} cannot be fetched: ${response.status}`);
      // hosts that do not know the type of the file
      return WebAssembly.compile(await response.arrayBuffer());
    };
    let module;
    try {
      module = await WebAssembly.compileStreaming(fetch(url)).catch(compiled);
    } catch (error) {
      if (error instanceof WebAssembly.CompileError) {
        throw new Error("this browser has no vector instructions of WebAssembly: use a version of 2023 or later");
      }
      throw error;
    }
    await init({ module_or_path: module });
    return new Engine(module);
  }

  constructor(module) {
    const told = JSON.parse(about()), { colours } = told;
    for (const scale of ["sequential", "diverging"]) colours[scale] = Uint8Array.from(colours[scale]);
    this.about = told;
    this.module = module;
    this.waiting = [];
    this.running = null;
    this.made = [];
    this.count = 0;
    this.begin();
  }

  /* Starts the thread, which makes the surface again if there was one. */
  begin() {
    this.worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = event => this.fail(event.message || "the engine did not start");
    this.worker.postMessage({ module: this.module });
    this.answers = false;
    this.lost = this.made.length > 0;
  }

  hear({ id, seen, found, error, ended }) {
    this.answers = true;
    const job = this.running;
    if (job?.id !== id) return;
    if (seen) return seen.state ? job.onstate?.(seen.state.row, seen.state) : job.onprogress?.(seen);
    this.running = null;
    if (ended) this.restart();
    if (error === undefined) {
      this.keep(job, found);
      job.resolve(found);
    } else {
      job.reject(new Error(error));
    }
    this.next();
  }

  /* Keeps what makes the surface, for another thread. */
  keep({ call, args }, found) {
    if (!MADE.includes(call) || found.heights === null) return;
    this.made = call === "prepare" ? [this.made[0], { call, args }] : [{ call, args }];
    this.lost = false;
  }

  /* Refuses all calls; another thread is of use only where this one has worked. */
  fail(message) {
    const jobs = this.jobs();
    if (this.answers) this.restart();
    else this.broken = message;
    jobs.forEach(job => job.reject(new Error(message)));
  }

  /* Takes the calls that run and wait. */
  jobs() {
    const jobs = [this.running, ...this.waiting].filter(Boolean);
    this.running = null;
    this.waiting = [];
    return jobs;
  }

  restart() {
    this.worker.terminate();
    this.begin();
  }

  next() {
    if (this.running || !this.waiting.length) return;
    // what made the surface, unless the next call makes another one
    const { call } = this.waiting[0];
    if (this.lost && call !== "open" && call !== "make") {
      const silent = { resolve() {}, reject() {} };
      this.waiting.unshift(...this.made.map(job => ({ ...job, ...silent, id: ++this.count })));
      this.lost = false;
    }
    this.running = this.waiting.shift();
    const { id, call: name, args } = this.running;
    this.worker.postMessage({ id, call: name, args });
  }

  call(call, args, observers = {}) {
    return new Promise((resolve, reject) => {
      if (this.broken) throw new Error(this.broken);
      this.waiting.push({ id: ++this.count, call, args, resolve, reject, ...observers });
      this.next();
    });
  }

  /* Opens a map. The answer has `name`, `shape`, `lengths`, `unit`, `original`, `missing`, `unread`, `channels`, `heights`
     (f32, about their `mean`), `lowest`, `highest`, and `warnings` of `code` and `message`. Of a file whose channel has to
     be chosen `heights` is null: call again with the number in front of one of its `channels`. */
  open(name, bytes, { channel } = {}) {
    return this.call("open", [name, bytes, channel]);
  }

  /* Makes a surface by the keys of `asperity surface`; the answer is that of `open`. */
  make(parameters) {
    return this.call("make", [JSON.stringify(parameters)]);
  }

  /* Makes the surface of the map by the steps of `asperity prepare`, never of a prepared one; the answer is that of
     `open`, with `log`, pairs of a step and what it did. */
  prepare(steps) {
    return this.call("prepare", [JSON.stringify(steps)]);
  }

  /* `figures` and `rows` of the surface, as of `asperity stats`, its `spectrum` and the `histogram` of its heights. */
  statistics() {
    return this.call("statistics", []);
  }

  /* Solves by the keys of `asperity solve`, from the last solution or the default start. Of the solves that wait only the
     newest is done, and the others come to null. The answer has the report as `account`, its `rows` for people, its
     `shortfalls`, how it `started`, the `fields` that are wanted on their `shape`, with `extremes`, and the `limits` of
     the colours. Nodes of the contact are 0 apart, 1 in contact, 2 absent, 3 attractive, 4 yielded. */
  solve(scene, { start = "default", fields = ["contact", "pressure", "gap"], histograms = 0, onprogress } = {}) {
    const older = this.waiting.filter(job => job.call === "solve");
    this.waiting = this.waiting.filter(job => job.call !== "solve");
    older.forEach(job => job.resolve(null));
    return this.call("solve", [JSON.stringify(scene), { start, fields, histograms }], { onprogress });
  }

  /* Follows loads by the keys of `asperity cycle`; `onstate` gets the row of each state as it is found, and beside it the
     share of the way. */
  follow(scene, { onstate, onprogress }) {
    return this.call("follow", [JSON.stringify(scene)], { onstate, onprogress });
  }

  /* The lines that give the same answer: of a `shell` one by one, and of `python`. */
  lines() {
    return this.call("lines", []);
  }

  /* A file to take away: `heights.npz`, and of the last solution `fields.npz`, `report.json`, `scene.toml`, the gap
     `start.npz` from which it started, or `table.csv` of the loads that were followed. */
  async download(name) {
    const types = { json: "application/json", toml: "application/toml", csv: "text/csv", npz: "application/zip" };
    const bytes = await this.call("file", [name]);
    return { name, type: types[name.split(".").pop()] ?? "application/octet-stream", bytes };
  }

  /* A chart as SVG, drawn at once on the thread of the page. */
  chart(given) {
    return chart(JSON.stringify(given));
  }

  /* Ends what runs and what waits. */
  cancel() {
    const jobs = this.jobs();
    if (!jobs.length) return;
    this.restart();
    jobs.forEach(job => job.reject(new DOMException("it was cancelled", "AbortError")));
  }
}
