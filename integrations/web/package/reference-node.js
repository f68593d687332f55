// The entry for Node: the module is there when this is imported.

import { api } from "./api.js";
import { GlistenError, Module } from "./module.js";
import { readFileSync } from "node:fs";
export { GlistenError };

const functions = api(new Module(new WebAssembly.Module(readFileSync(new URL("./reference.wasm", import.meta.url)))));

/** Nothing is left to do in Node. */
export async function init() {}

const ready = () => functions;

export const compile = (...given) => ready().compile(...given);
export const lint = (...given) => ready().lint(...given);
export const fix = (...given) => ready().fix(...given);
export const reflect = (...given) => ready().reflect(...given);
export const upgrade = (...given) => ready().upgrade(...given);
export const format = (...given) => ready().format(...given);
export const versions = () => ready().versions();
export const render = (...given) => ready().render(...given);
