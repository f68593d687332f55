// What the modules weigh, as a browser gets them.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { folder } from "./package.mjs";

// In bytes, gzipped.
for (const [module, most] of [["compiler", 1_000_000], ["reference", 2_500_000]]) {
  test(`${module}.wasm weighs at most ${most} bytes`, () => {
    const weight = gzipSync(readFileSync(join(folder, `${module}.wasm`)), { level: 9 }).length;
    assert.ok(weight <= most, `it weighs ${weight}`);
  });
}
