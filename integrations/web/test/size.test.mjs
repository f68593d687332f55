// What the modules weigh, as a browser gets them.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { folder } from "./package.mjs";

// The standard library that comes with rustup's target is built for speed.
const note = join(folder, "../standard-library");
const isReady = existsSync(note) && readFileSync(note, "utf8").trim() === "ready";
// In bytes, gzipped.
for (const [module, most] of [["compiler", (isReady ? 1.1 : 1) * 2 ** 20], ["reference", 2_500_000]]) {
  test(`${module}.wasm weighs at most ${Math.round(most)} bytes`, () => {
    const weight = gzipSync(readFileSync(join(folder, `${module}.wasm`)), { level: 9 }).length;
    assert.ok(weight <= most, `it weighs ${weight}`);
  });
}
