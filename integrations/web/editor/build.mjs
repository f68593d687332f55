// Makes the scripts of the page of `glisten play`: the editor, with the licences of all that is in it, and the worker of a page that
// has glisten as a module.

import { build } from "esbuild";
import { existsSync, readFileSync } from "node:fs";

const out = "../../../crates/cli/src/commands/play/page";
const common = { bundle: true, minify: true, format: "iife", target: "es2022", metafile: true };
const editor = { ...common, entryPoints: ["editor.mjs"], globalName: "Editor" };
const tried = await build({ ...editor, write: false });
const packages = new Set();
for (const file of Object.keys(tried.metafile.inputs)) {
  const found = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(file);
  if (found) packages.add(found[1]);
}
// Packages with the same licence share its text.
const texts = new Map();
for (const name of [...packages].sort()) {
  const file = `node_modules/${name}/LICENSE`;
  if (!existsSync(file)) throw new Error(`${name} has no licence`);
  const text = readFileSync(file, "utf8").trim();
  texts.set(text, [...(texts.get(text) ?? []), name]);
}
const banner = [...texts].map(([text, names]) => `/*!\n${names.join(", ")}\n\n${text}\n*/`).join("\n");
await build({ ...editor, banner: { js: banner }, outfile: `${out}/editor.js` });
await build({ ...common, entryPoints: ["worker.mjs"], outfile: `${out}/worker.js` });
console.log(`${packages.size} packages, ${texts.size} licences`);
