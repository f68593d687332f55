// Builds the shaders of projects for WebGL by the plugin for Vite, and asks judges about the WGSL:
// `node integrations/web/projects.mjs FOLDER... [--engine FOLDER=NAME]... [--list]`.
//
// Each folder is a project. Every fragment shader is imported as an application would, with its vertex shader, and alone vertex shaders, too; what
// has no `main` is a part of others. A text that `glslangValidator` refuses as OpenGL ES is told apart. The judges are Tint, of the npm package `webgpu`
// in target/tint, and the WebGPU of Chromium, by playwright-core in target/browser: it makes a pipeline of each program, with the layout of
// bindings and the buffers of attributes that the reflection tells, and draws with it once. Prints a table; with --list, each program that is not built, with the reason.

import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { opened } from "./test/chromium.mjs";
import { compared } from "./test/layout.mjs";
import { root, vite } from "./test/package.mjs";

const { default: glisten } = await import(pathToFileURL(vite).href);
const words = process.argv.slice(2);
const lists = words.includes("--list");
const engines = new Map();
const folders = [];
while (words.length) {
  const word = words.shift();
  if (word === "--engine") { const [folder, name] = words.shift().split("="); engines.set(resolve(folder), name); }
  else if (word !== "--list") folders.push(resolve(word));
}
const { create } = await import(pathToFileURL(join(root, "target/tint/node_modules/webgpu/index.js")).href);
// It has to stay as long as its device.
const gpu = create(["backend=null"]);
const device = await (await gpu.requestAdapter()).requestDevice();
const tint = async (code) => {
  device.pushErrorScope("validation");
  const module = device.createShaderModule({ code });
  const told = await module.getCompilationInfo();
  const error = await device.popErrorScope();
  return told.messages.find((one) => one.type === "error")?.message ?? error?.message ?? null;
};
const chromium = await opened();
/** The complaint of glslang about a text as it is, which WebGL takes for OpenGL ES. */
const glslang = (name, text) => {
  const folder = mkdtempSync(join(tmpdir(), "glisten-"));
  try {
    const version = /^\s*#version/m.test(text) ? "" : "#version 100\n";
    const file = join(folder, `a.${/vert|vs|vp/i.test(basename(name)) ? "vert" : "frag"}`);
    writeFileSync(file, version + text);
    const ran = spawnSync("glslangValidator", [file], { encoding: "utf8" });
    return ran.status === 0 ? null : (ran.stdout.split("\n").find((line) => line.startsWith("ERROR")) ?? "refused");
  } finally {
    rmSync(folder, { recursive: true });
  }
};
const isShader = (name) => /\.(vert|frag|vsh|fsh|vs|fs|glsl)$/.test(name);
const hasMain = (text) => /\bvoid\s+main\s*\(/.test(text.replace(/\/\/.*|\/\*[^]*?\*\//g, ""));

console.log("| project | commit | programs | built | accepted by Tint | drawn by Chromium | lone stages accepted | places read back | refused by glslang, too | others |");
console.log("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
const all = [0, 0, 0, 0, 0, 0, 0, 0];
let isRight = true;
for (const folder of folders) {
  const row = { programs: 0, built: 0, accepted: 0, drawn: 0, lone: 0, places: 0, refused: 0, others: 0 };
  const options = { folders: [folder], options: { ...(engines.has(folder) ? { engine: engines.get(folder) } : {}), allow: ["W0108"] } };
  const plugin = glisten(options);
  const files = readdirSync(folder, { recursive: true }).map((name) => join(folder, name)).filter((name) => isShader(name) && !name.includes("node_modules")).sort();
  const done = new Set();
  for (const file of files) {
    if (done.has(file) || !hasMain(readFileSync(file, "utf8"))) continue;
    const watched = new Set(), errors = [];
    const host = { addWatchFile: (name) => watched.add(name), error: (error) => { errors.push(error.message); return null; }, warn: () => {} };
    let code = null;
    try { code = await plugin.load.call(host, `${file}?glisten`); } catch (error) { errors.push(error.message); }
    // The sources of the program come first.
    const sources = [...watched].filter((name) => isShader(name) && hasMain(readFileSync(name, "utf8")));
    [file, ...sources].forEach((name) => done.add(name));
    row.programs += 1;
    const say = (text) => { if (lists) console.log(`  ${file.slice(folder.length + 1)}: ${text.trim().split("\n")[0]}`); };
    if (code === null || errors.length) {
      const complaint = [file, ...sources].map((name) => glslang(name, readFileSync(name, "utf8"))).find((one) => one !== null);
      row[complaint ? "refused" : "others"] += 1;
      say(`${complaint ? "" : "glslangValidator takes it: "}${errors[0] ?? "not built"}`);
      continue;
    }
    row.built += 1;
    const program = JSON.parse(code.replace(/^export default |;$/g, ""));
    let isAccepted = true;
    for (const stage of ["vertex", "fragment"].filter((stage) => program[stage])) {
      const complaint = await tint(program[stage]);
      if (complaint) { isAccepted = false; say(`Tint: ${complaint}`); }
    }
    row.accepted += isAccepted;
    const told = compared(program.reflection, [program.vertex, program.fragment].filter(Boolean));
    row.places += told.count;
    told.complaints.forEach((one) => say(`reflection: ${one}`));
    const complaint = chromium ? await chromium.complaint(program) : null;
    if (complaint) say(`Chromium: ${complaint}`);
    row.drawn += complaint === "";
    row.lone += chromium !== null && complaint === null;
    isRight &&= !complaint && told.complaints.length === 0;
  }
  const git = existsSync(join(folder, ".git")) ? execFileSync("git", ["-C", folder, "rev-parse", "--short=7", "HEAD"], { encoding: "utf8" }).trim() : "";
  const counts = [row.programs, row.built, row.accepted, row.drawn, row.lone, row.places, row.refused, row.others];
  counts.forEach((count, index) => { all[index] += count; });
  isRight &&= row.built === row.accepted;
  console.log(`| ${basename(folder).replace("+", "/")} | ${git} | ${counts.join(" | ")} |`);
}
console.log(`| all | | ${all.join(" | ")} |`);
console.log(chromium ? `\nDrawn by ${chromium.name}.` : "\nNo Chromium with WebGPU was found: nothing was drawn.");
await chromium?.close();
// Dawn keeps the process alive.
process.exit(isRight ? 0 : 1);
