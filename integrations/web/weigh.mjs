// What the module that was built last consists of: `node integrations/web/weigh.mjs [MODULE.wasm]`.
//
// The module is the one with names, before wasm-opt (target/web/wasm32-unknown-unknown/release/glisten_web.wasm). Prints the bytes of code by
// crate, generic code with the crate that made it, and the data. Bytes are before wasm-opt; gzipped, the module weighs about two fifths.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [path = fileURLToPath(new URL("../../target/web/wasm32-unknown-unknown/release/glisten_web.wasm", import.meta.url))] = process.argv.slice(2);
const bytes = readFileSync(path);
let at = 8;
const number = () => {
  let [value, shift] = [0, 0];
  for (;;) {
    const byte = bytes[at];
    at += 1;
    value += (byte & 127) * 2 ** shift;
    shift += 7;
    if (byte < 128) return value;
  }
};
const text = () => {
  const length = number();
  at += length;
  return bytes.toString("utf8", at - length, at);
};
const [names, sizes] = [new Map(), []];
let imported = 0;
let data = 0, packed = 0;
const sections = {
  2: () => {
    for (let left = number(); left > 0; left -= 1) {
      text(); text();
      if (bytes[at] !== 0) return;
      at += 1; number(); imported += 1;
    }
  },
  10: () => {
    for (let left = number(); left > 0; left -= 1) {
      const size = number();
      sizes.push(size);
      at += size;
    }
  },
  11: (end) => { data = end - at; packed = gzipSync(bytes.subarray(at, end), { level: 9 }).length; },
  0: (end) => {
    if (text() !== "name") return;
    while (at < end) {
      const kind = bytes[at];
      at += 1;
      const size = number();
      const next = at + size;
      if (kind === 1) for (let left = number(); left > 0; left -= 1) { const index = number(); names.set(index, text()); }
      at = next;
    }
  },
};
while (at < bytes.length) {
  const kind = bytes[at];
  at += 1;
  const size = number();
  const end = at + size;
  sections[kind]?.(end);
  at = end;
}
// The crates that a mangled name has, as `C`, a number to tell equal ones apart, a length, the name (RFC 2603); or, before that, the first part.
const OF_RUST = new Set(["core", "alloc", "std", "hashbrown", "compiler_builtins"]);
const cratesOf = (name) => {
  const found = [...name.matchAll(/C(?:s[0-9A-Za-z]*_)?(\d+)_?/g)].map((one) => name.slice(one.index + one[0].length).slice(0, Number(one[1])));
  const old = /^_ZN(\d+)/.exec(name);
  return old ? [name.slice(old[0].length).slice(0, Number(old[1]))] : found.filter((crate) => /^[a-z][a-z0-9_]*$/.test(crate));
};
const byCrate = new Map();
sizes.forEach((size, index) => {
  const crates = cratesOf(names.get(index + imported) ?? "");
  const crate = crates.find((one) => !OF_RUST.has(one)) ?? (crates.length ? "the standard library" : "other");
  byCrate.set(crate, (byCrate.get(crate) ?? 0) + size);
});
const code = sizes.reduce((sum, size) => sum + size, 0);
const row = (name, size) => console.log(`${name.padEnd(28)} ${String(size).padStart(9)} ${((100 * size) / (code + data)).toFixed(1).padStart(6)} %`);
for (const [crate, size] of [...byCrate].sort((a, b) => b[1] - a[1]).filter(([, size]) => size >= 0.005 * (code + data))) row(crate, size);
row("smaller crates", [...byCrate.values()].filter((size) => size < 0.005 * (code + data)).reduce((sum, size) => sum + size, 0));
row("data: tables, messages", data);
console.log(`The data are ${packed} bytes gzipped.`);
