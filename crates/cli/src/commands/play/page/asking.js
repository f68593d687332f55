
// ---- Where answers come from: the server of `glisten play`, or glisten as a module in the page. Both have two kinds of questions, `look`
// and the others; a newer one of a kind ends an older one, but for questions on the last picture.
const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const through = async (bytes, transform) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(transform)).arrayBuffer());

// A worker with the module. It is ended with what it does, and the next question starts another.
const makeLane = (begun, milliseconds) => {
  let worker = null, count = 0;
  const waiting = new Map();
  const settle = (number, answer) => {
    const one = waiting.get(number);
    if (!one) return;
    clearTimeout(one.timer);
    waiting.delete(number);
    one.resolve(answer);
  };
  const end = (answer) => {
    worker?.terminate();
    worker = null;
    for (const number of [...waiting.keys()]) settle(number, answer);
  };
  const begin = ({ script, first }) => {
    worker = new Worker(script);
    worker.onmessage = ({ data: { number, ok, bytes, error } }) => settle(number, error === undefined ? { status: 200, ok, bytes } : { status: 200, error });
    worker.onerror = (event) => end({ status: 500, error: event.message ?? "the worker ended" });
    worker.postMessage(first);
  };
  return async (job, endsOlder, planes = []) => {
    const start = await begun;
    if (endsOlder && waiting.size) end({ status: 409, error: "a newer question came" });
    if (!worker) begin(start);
    const number = count += 1;
    return new Promise((resolve) => {
      const timer = setTimeout(() => end({ status: 200, error: `it took longer than ${milliseconds / 1000} s` }), milliseconds);
      waiting.set(number, { resolve, timer });
      worker.postMessage({ number, job, planes });
    });
  };
};

const plainName = (name) => {
  const parts = [];
  for (const part of name.split("/")) {
    if (part === ".." && parts.length && parts.at(-1) !== "..") parts.pop();
    else if (part !== "" && part !== ".") parts.push(part);
  }
  return parts.join("/");
};

// Answers of the module in the page.
const makeModule = ({ module, worker, files, request, seconds }) => {
  const held = Object.fromEntries(Object.entries(files).map(([name, { text, bytes }]) => [name, text === undefined ? bytesOf(bytes) : new TextEncoder().encode(text)]));
  // Whose bytes are not UTF-8 would come back as others.
  const own = new Set(Object.keys(files).filter((name) => files[name].text !== undefined).map(plainName));
  const begun = (async () => {
    const bytes = bytesOf(module.bytes);
    const compiled = await WebAssembly.compile(module.is_packed ? await through(bytes, new DecompressionStream("gzip")) : bytes);
    return { script: URL.createObjectURL(new Blob([worker], { type: "text/javascript" })), first: { compiled, files: held, request } };
  })();
  const [looks, draws] = [makeLane(begun, seconds * 1000), makeLane(begun, seconds * 1000)];
  // A verdict takes longer: the scene is drawn as many simulated GPUs would.
  const judgements = makeLane(begun, seconds * 10000);
  // A study takes long, too, and ends neither a picture nor a verdict.
  const studies = makeLane(begun, seconds * 10000);
  let gpu = null;
  const opened = async () => {
    if (!gpu || (await gpu)?.isLost) gpu = openGpu().catch(() => null);
    return gpu;
  };
  const byGpu = async (job, lane, ask) => {
    const gpu = await opened();
    if (!gpu) return { status: 200, error: "this browser has no WebGPU" };
    const planned = await draws({ ...job, ask: "plan" }, true);
    if (!planned.ok) return planned;
    try {
      // A verdict is about what the browser makes of the programs now.
      if (lane === judgements) gpu.pipelines.clear();
      const from = performance.now();
      const planes = await drawByWebGpu(gpu, planned.ok, planned.bytes);
      const milliseconds = performance.now() - from;
      gpu.positions ??= await measurePositions(gpu);
      const { bits, exact } = gpu.positions;
      const by = `${gpu.name}, by WebGPU, which interpolates between positions ${exact ? "of floats" : `of ${bits} bits`}`;
      const answer = await lane({ ...job, ask, by, positions: gpu.positions }, lane === judgements, planes);
      if (answer.ok) answer.ok.milliseconds = milliseconds;
      return answer;
    } catch (error) {
      return { status: 200, error: error.message };
    }
  };
  // A pixel is told by who drew it last.
  let last = draws;
  const ask = async (job) => {
    if (job.ask === "draw" || job.ask === "judge") {
      last = job.ask === "judge" ? judgements : draws;
      if (job.ask === "judge") return byGpu(job, judgements, "judge-shown");
      if (job.gpu) return byGpu(job, draws, "show");
    }
    if (job.ask === "needs" || job.ask === "stability") return studies(job, true);
    const answer = await (job.ask === "look" ? looks(job, true) : job.ask === "pixel" ? last(job, false) : draws(job, job.ask !== "trace"));
    for (const file of answer.ok?.files ?? []) file.is_writable = own.has(plainName(file.name));
    return answer;
  };
  return { ask, hasGpu: async () => (await opened()) !== null };
};

// The state of the page in its address: the scene, and the texts that differ from those that it came with.
const LONGEST_LINK = 1 << 20;
const packed = async (state) => {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(state)), new CompressionStream("deflate-raw"));
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(letters).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
};
const unpacked = async (text) => {
  const bytes = bytesOf(text.replace(/-/g, "+").replace(/_/g, "/"));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const parts = [];
  for (let length = 0; ;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    // A few bytes can be packed texts without end.
    if (length > LONGEST_LINK) throw new Error("its texts are too long");
    parts.push(value);
  }
  const state = JSON.parse(await new Blob(parts).text());
  const isText = (one) => typeof one === "string";
  if (!isText(state?.scene) || typeof state.texts !== "object" || !Object.values(state.texts ?? {}).every(isText)) throw new Error("it is no link of this page");
  return state;
};
