// How long calls of the package take, and what it weighs: `node integrations/web/bench.mjs`.

import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { compiler, files, reference, root } from "./test/package.mjs";

const ROUNDS = 30;
const median = (work) => {
  const times = Array.from({ length: ROUNDS }, () => {
    const start = performance.now();
    work();
    return performance.now() - start;
  });
  return times.sort((a, b) => a - b)[ROUNDS / 2];
};
const sources = ["vert", "frag"].map((extension) => {
  const name = `fixtures/programs/phong.${extension}`;
  return { name, text: readFileSync(join(root, name), "utf8") };
});
const scene = "fixtures/scenes/phong.toml";
const all = files("fixtures/scenes", "fixtures/programs");
const rows = [
  ["a program to WGSL, with reflection", () => compiler.compile(sources)],
  ["its findings", () => compiler.lint(sources)],
  ["its format", () => compiler.format(sources[1].text)],
  ["the picture of fixtures/scenes/phong.toml", () => reference.render(scene, all)],
];
const bytes = sources.reduce((sum, { text }) => sum + text.length, 0);
console.log(`two sources of ${bytes} bytes; medians of ${ROUNDS} calls, in ms`);
for (const [name, work] of rows) console.log(`${name.padEnd(44)} ${median(work).toFixed(2)}`);
for (const module of ["compiler", "reference"]) {
  const path = join(process.env.GLISTEN_WEB ?? join(root, "target/web/package"), `${module}.wasm`);
  console.log(`${module}.wasm`.padEnd(44), `${statSync(path).size} bytes, ${gzipSync(readFileSync(path), { level: 9 }).length} gzipped`);
}
