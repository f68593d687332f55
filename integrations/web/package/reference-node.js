// The entry for Node: the module is there when this is imported.

import { api } from "./api.js";
import { Module } from "./module.js";
import { readFileSync } from "node:fs";

export { GlistenError } from "./module.js";
export const { compile, lint, fix, reflect, upgrade, format, stageOf, versions, render } = api(
  new Module(new WebAssembly.Module(readFileSync(new URL("./reference.wasm", import.meta.url)))),
);

/** Nothing is left to do in Node. */
export async function init() {}
