// What the modules weigh, as a browser gets them.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { folder } from "./package.mjs";

// The standard library that comes with rustup's target is built for speed.
const note = join(folder, "../standard-library");
const isReady = existsSync(note) && readFileSync(note, "utf8").trim() === "ready";

// The bytes of a file by `gzip -9`, as a server keeps it. Node's own zlib, which is built for speed, makes a hundredth more.
function gzipped(file) {
  const packed = spawnSync("gzip", ["-9", "-c", file], { maxBuffer: 2 ** 28 });
  return packed.status === 0 ? packed.stdout.length : gzipSync(readFileSync(file), { level: 9 }).length / 1.01;
}

// In bytes, gzipped.
for (const [module, most] of [["compiler", (isReady ? 1.1 : 1) * 1_000_000], ["reference", 2_500_000]]) {
  test(`${module}.wasm weighs at most ${Math.round(most)} bytes`, () => {
    const weight = gzipped(join(folder, `${module}.wasm`));
    assert.ok(weight <= most, `it weighs ${weight}`);
  });
}
