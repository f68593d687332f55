// The entry for browsers: call `init` once before anything else.

import { api } from "./api.js";
import { GlistenError, Module } from "./module.js";

export { GlistenError };

let functions = null;
let starting = null;

/** Loads the module: from next to this file, or from a URL, a response, bytes or a compiled module. */
export function init(from = new URL("./compiler.wasm", import.meta.url)) {
  starting ??= load(from).then((compiled) => {
    functions = api(new Module(compiled));
  });
  // What failed may be tried again.
  starting.catch(() => {
    starting = null;
  });
  return starting;
}

async function load(from) {
  if (from instanceof WebAssembly.Module) return from;
  if (from instanceof ArrayBuffer || ArrayBuffer.isView(from)) return WebAssembly.compile(from);
  const response = from instanceof Response ? from : await fetch(from);
  if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
  // Some servers name another type, which streaming refuses.
  return WebAssembly.compile(await response.arrayBuffer());
}

function ready() {
  if (!functions) throw new GlistenError("the module is not loaded: await init() first", "argument");
  return functions;
}

export const compile = (...given) => ready().compile(...given);
export const lint = (...given) => ready().lint(...given);
export const fix = (...given) => ready().fix(...given);
export const reflect = (...given) => ready().reflect(...given);
export const upgrade = (...given) => ready().upgrade(...given);
export const format = (...given) => ready().format(...given);
export const versions = () => ready().versions();
