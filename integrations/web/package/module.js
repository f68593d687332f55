// A WebAssembly module of glisten: requests and replies are a JSON text and bytes.

/** What a shader, a scene or an argument has wrong. */
export class GlistenError extends Error {
  constructor(message, kind, diagnostics = []) {
    super(message);
    this.name = "GlistenError";
    this.kind = kind;
    this.diagnostics = diagnostics;
  }
}

/** Whether an engine says that its stack is too small: V8 and JavaScriptCore by a `RangeError`, SpiderMonkey by its own error. */
const isOverflow = (trap) => /call stack|too much recursion/i.test(trap.message ?? "");

/** The error of sources that an engine's stack is too small for. */
function overflow(request) {
  const message = "the source nests too deep, or has too long a chain of operators, for the stack of this JavaScript engine";
  const file = request.sources?.[0]?.name ?? request.path ?? "";
  const place = { file, line: 1, column: 1, end_line: 1, end_column: 1 };
  const told = { severity: "error", code: "E0003", name: "nesting-too-deep", message };
  const nothing = { help: null, fixes: [], labels: [], notes: [], section: null, presented_line: null };
  return new GlistenError(`error[E0003]: ${message}`, "content", [{ ...place, ...told, ...nothing }]);
}

/** Calls of one module. A trap ends its instance, and the next call gets a new one. */
export class Module {
  constructor(compiled) {
    this.compiled = compiled;
    this.instance = null;
  }

  call(request, blob = new Uint8Array()) {
    this.instance ??= new WebAssembly.Instance(this.compiled, {});
    const { glisten_reserve, glisten_call, glisten_reply, glisten_fault, memory } = this.instance.exports;
    const read = (length) => new Uint8Array(memory.buffer, glisten_reply() >>> 0, length >>> 0).slice();
    const text = new TextEncoder().encode(JSON.stringify(request));
    let reply;
    try {
      const at = glisten_reserve(4 + text.length + blob.length) >>> 0;
      new DataView(memory.buffer).setUint32(at, text.length, true);
      new Uint8Array(memory.buffer).set(text, at + 4);
      new Uint8Array(memory.buffer).set(blob, at + 4 + text.length);
      reply = read(glisten_call());
    } catch (trap) {
      this.instance = null;
      if (isOverflow(trap)) throw overflow(request);
      let why = "";
      try {
        why = new TextDecoder().decode(read(glisten_fault()));
      } catch {
        // The instance cannot say.
      }
      throw new GlistenError(`internal error: ${why || trap.message}; please report it with the input`, "internal");
    }
    const length = new DataView(reply.buffer).getUint32(0, true);
    const object = JSON.parse(new TextDecoder().decode(reply.subarray(4, 4 + length)));
    if (object.error) throw new GlistenError(object.error.message, object.error.kind, JSON.parse(object.error.diagnostics ?? "[]"));
    object.bytes = ([offset, count]) => reply.slice(4 + length + offset, 4 + length + offset + count);
    return object;
  }

  /** Calls, and asks `include` for what is missing until nothing is. */
  asked(request, include, blob) {
    if (typeof include !== "function") return this.call(request, blob);
    const answers = [];
    for (;;) {
      const reply = this.call({ ...request, asks: true, answers }, blob);
      if (!reply.wanted) return reply;
      const known = new Set(answers.map(key));
      for (const one of reply.wanted) {
        if (known.has(key(one))) continue;
        known.add(key(one));
        const found = include(one.path, one.angled, one.from) ?? null;
        answers.push({ ...one, ...(typeof found === "string" || found === null ? { text: found } : found) });
      }
    }
  }
}

const key = ({ path, angled, from }) => JSON.stringify([path, angled, from]);
