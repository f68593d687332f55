// The functions of a module for browsers: `init` loads it, and is called once before anything else.

import { api } from "./api.js";
import { GlistenError, Module } from "./module.js";

async function load(from) {
  if (from instanceof WebAssembly.Module) return from;
  if (from instanceof ArrayBuffer || ArrayBuffer.isView(from)) return WebAssembly.compile(from);
  const response = from instanceof Response ? from : await fetch(from);
  if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
  // Some servers name another type, which streaming refuses.
  return WebAssembly.compile(await response.arrayBuffer());
}

/** The functions on the module at a URL, which fail until `init` has ended. */
export function browser(url) {
  let functions = null;
  let starting = null;
  const init = (from = url) => {
    starting ??= load(from).then((compiled) => {
      functions = api(new Module(compiled));
    });
    // What failed may be tried again.
    starting.catch(() => {
      starting = null;
    });
    return starting;
  };
  const later = (name) => (...given) => {
    if (!functions) throw new GlistenError("the module is not loaded: await init() first", "argument");
    return functions[name](...given);
  };
  // Their names are known without a module.
  return { init, ...Object.fromEntries(Object.keys(api(null)).map((name) => [name, later(name)])) };
}
