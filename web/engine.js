/* The engine as the page calls it: one call after the other, on the thread of `worker.js`.

   Keys are named as in reports, as `work_of_adhesion`. Values are as they were typed: strings with units such as "70GPa", or
   numbers; what is empty counts as not given. Every call is a promise, refused with the sentence of the program. Fields
   are typed arrays, node (i, j) at index i ny + j, with i along x and j along y.

   A call that runs cannot be interrupted: to cancel, its thread is ended, and the next call starts another one, which
   makes the surface again. So no shared memory is needed, which few hosts allow. Threads start from what the page
   holds, the compiled module and the text of the scripts, and need no network. */

import init, { about, chart } from "./asperity_web.js";

const MADE = ["open", "make", "prepare"];

/* A file next to this one. */
async function fetched(name) {
  const answer = await fetch(new URL(name, import.meta.url)).catch(({ message }) => ({ status: message }));
  if (!answer.ok) throw new Error(`${name} has not come from the server (${answer.status})`);
  return answer;
}

export class Engine {
  /* Starts the engine: fetches and compiles all that it takes, after which no network is needed. */
  static async start() {
    try {
      const names = ["asperity_web_bg.wasm", "asperity_web.js", "worker.js"];
      const [code, ...scripts] = await Promise.all(names.map(fetched));
      // not all hosts know the type of the file
      const isKnown = code.headers.get("Content-Type") === "application/wasm";
      const module = isKnown
        ? await WebAssembly.compileStreaming(code)
        : await WebAssembly.compile(await code.arrayBuffer());
      const texts = await Promise.all(scripts.map(script => script.text()));
      await init({ module_or_path: module });
      return new Engine(module, URL.createObjectURL(new Blob(texts, { type: "text/javascript" })));
    } catch (error) {
      const isOld = error instanceof WebAssembly.CompileError;
      const told = "this browser has no vector instructions of WebAssembly: use a version of 2023 or later";
      throw new Error(isOld ? `${told} (${error.message})` : `${error.message}: reload the page`);
    }
  }

  /* An engine of the compiled module and the address of the script of its threads. */
  constructor(module, script) {
    const told = JSON.parse(about()), { colours } = told;
    for (const scale of ["sequential", "diverging"]) colours[scale] = Uint8Array.from(colours[scale]);
    this.about = told;
    this.module = module;
    this.script = script;
    this.worker = null;
    this.waiting = [];
    this.running = null;
    this.made = [];
    this.count = 0;
  }

  /* Another engine, with a thread of its own, on the surface of this one. */
  twin() {
    return Object.assign(new Engine(this.module, this.script), { made: this.made });
  }

  /* Starts a thread, which makes the surface again if there was one. */
  begin() {
    this.worker = new Worker(this.script, { type: "module" });
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = ({ message }) => this.fail(message);
    this.worker.onmessageerror = () => this.fail("an answer cannot be read");
    this.worker.postMessage({ module: this.module });
    this.lost = this.made.length > 0;
  }

  hear({ id, seen, found, error, ended }) {
    const job = this.running;
    if (job?.id !== id) return;
    if (seen) return seen.state ? job.onstate?.(seen.state.row, seen.state) : job.onprogress?.(seen);
    this.running = null;
    if (ended) this.end();
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

  /* Ends a thread that has failed, and refuses all calls; the next one starts another thread. */
  fail(why) {
    const jobs = this.jobs();
    this.end();
    const told = `the solver has stopped (${why || "its thread did not start"}): try again, or reload the page`;
    jobs.forEach(job => job.reject(Object.assign(new Error(told), { isOfThread: true })));
  }

  /* Takes the calls that run and wait. */
  jobs() {
    const jobs = [this.running, ...this.waiting].filter(Boolean);
    this.running = null;
    this.waiting = [];
    return jobs;
  }

  end() {
    this.worker?.terminate();
    this.worker = null;
  }

  next() {
    if (this.running || !this.waiting.length) return;
    try {
      if (!this.worker) this.begin();
      this.send();
    } catch (error) {
      // no thread, or no memory for what it gets
      this.fail(error.message);
    }
  }

  send() {
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
      this.waiting.push({ id: ++this.count, call, args, resolve, reject, ...observers });
      this.next();
    });
  }

  /* Opens a map. The answer has `name`, `shape`, `lengths`, `unit`, `original`, `missing`, `unread`, `channels`, `heights`
     (f32, about their `mean`), `lowest`, `highest`, the `limits` of the colours, and `warnings` of `code` and `message`.
     For a file with a choice of channels `heights` is null: call again with the number in front of one of its
     `channels`. The `masked` points of a file of Gwyddion are missing. */
  open(name, bytes, { channel, masked = false } = {}) {
    return this.call("open", [name, bytes, channel, masked]);
  }

  /* Makes a surface by the keys of `asperity surface`; answers as `open`. */
  make(parameters) {
    return this.call("make", [JSON.stringify(parameters)]);
  }

  /* Makes the surface of the map by the steps of `asperity prepare`, never of a prepared one; answers as
     `open`, with `log`, pairs of a step and what it did. */
  prepare(steps) {
    return this.call("prepare", [JSON.stringify(steps)]);
  }

  /* `figures` and `rows` of the surface, as by `asperity stats`, its `spectrum` and the `histogram` of its heights. */
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

  /* Follows loads by the keys of `asperity cycle`; `onstate` gets the row of each state as it is found, and with it the
     share of the way. */
  follow(scene, { onstate, onprogress }) {
    return this.call("follow", [JSON.stringify(scene)], { onstate, onprogress });
  }

  /* The gap of the last solution, and of another engine on the same surface, which starts its first solve from there. */
  gap() {
    return this.call("gap", []);
  }

  startFrom(gap) {
    return this.call("startFrom", [gap]);
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
    this.end();
    jobs.forEach(job => job.reject(new DOMException("it was cancelled", "AbortError")));
  }
}
