/* The engine of the page on a thread of its own: the library as WebAssembly.

   page -> worker  { id, call, args }         a method of the engine below, with its arguments
   worker -> page  { id, found }              its answer
                   { id, error }              the message of its error
                   { id, seen }               what an observer sees meanwhile
   The first message is { module }, the compiled module. What is thrown besides an answer, the page hears as an error of
   the thread.

   The page puts this text behind `asperity_web.js`, and uses its `initSync` and `Engine`. */

let engine, observed;

const parsed = text => JSON.parse(text);

/* A map with its heights. */
function map(told) {
  const found = parsed(told);
  return found.heights === null ? found : { ...found, heights: engine.heights() };
}

/* The fields that are wanted of the last solution. */
function fields(names) {
  return Object.fromEntries(names.map(name => [name, name === "contact" ? engine.regions() : engine.field(name)]));
}

const seen = (iteration, error, tolerance, contact_fraction, nodes) =>
  observed({ iteration, error, tolerance, contact_fraction, nodes });

const calls = {
  open: (name, bytes, channel, masked) => map(engine.open(name, new Uint8Array(bytes), channel, masked)),
  make: parameters => map(engine.make(parameters)),
  prepare: steps => map(engine.prepare(steps)),
  statistics: () => parsed(engine.statistics()),
  solve(scene, { start, fields: names, histograms }) {
    const answer = parsed(engine.solve(scene, start === "last", seen));
    if (histograms) answer.histograms = parsed(engine.histograms(histograms));
    return { ...answer, fields: fields(names) };
  },
  follow(scene) {
    const begun = parsed(engine.begin(scene));
    let count = 0, last = begun;
    const shortfalls = new Set();
    for (let told; (told = engine.next(seen)) !== undefined; count++) {
      last = parsed(told);
      last.shortfalls.forEach(text => shortfalls.add(text));
      observed({ state: last });
    }
    const told = engine.cycle_limit(seen),
      limit = told === undefined ? null : parsed(told);
    return { ...begun, limit, count, status: "complete", warnings: last.warnings, shortfalls: [...shortfalls] };
  },
  gap: () => engine.gap(),
  startFrom: gap => engine.start_from(gap),
  file: name => engine.file(name),
  lines: () => parsed(engine.lines()),
};

/* The memory of what an answer has besides its figures goes to the page, and is not copied. */
function buffers(found) {
  const arrays = ArrayBuffer.isView(found) ? [found] : [found?.heights, ...Object.values(found?.fields ?? {})];
  return arrays.filter(ArrayBuffer.isView).map(array => array.buffer);
}

onmessage = ({ data: { module, id, call, args } }) => {
  if (module) {
    initSync({ module });
    engine = new Engine();
    return;
  }
  observed = what => postMessage({ id, seen: what });
  try {
    const found = calls[call](...args);
    postMessage({ id, found }, buffers(found));
  } catch (error) {
    const memory = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    const ended = memory || error.message.startsWith(FAULT);
    postMessage({ id, error: memory ? MEMORY : error.message, ended });
  }
};

onmessageerror = () => { throw new Error("a call cannot be read"); };

const FAULT = "the engine has failed";
const MEMORY = "the memory of the page did not suffice: use fewer nodes, as by the step resample, or f32";
