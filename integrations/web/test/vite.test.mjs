// The plugin for Vite, with what Vite calls of it.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { vite } from "./package.mjs";

const { default: glisten } = await import(pathToFileURL(vite).href);

/** What an import of a file gives, in a folder with these files; the files that are watched, and the errors. */
async function imported(texts, name, options = {}) {
  const folder = realpathSync(mkdtempSync(join(tmpdir(), "glisten-")));
  try {
    for (const [file, text] of Object.entries(texts)) {
      mkdirSync(dirname(join(folder, file)), { recursive: true });
      writeFileSync(join(folder, file), text);
    }
    const [watched, errors, warnings] = [[], [], []];
    const host = {
      addWatchFile: (file) => watched.push(file.slice(folder.length + 1)),
      error: (error) => errors.push(error),
      warn: (warning) => warnings.push(warning),
    };
    const plugin = glisten(options);
    plugin.configResolved({ root: folder });
    const id = await plugin.resolveId.call(host, `./${name}?glisten`, join(folder, "main.js"));
    const code = await plugin.load.call(host, id);
    const module = errors.length === 0 ? (await import(`data:text/javascript,${encodeURIComponent(code)}`)).default : null;
    return { module, watched: [...new Set(watched)].sort(), errors, warnings };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
const fragment = "#version 150\nout vec4 c;\nuniform float k;\nvoid main() { c = vec4(k); }\n";

test("a program is its two sources, from either", async () => {
  for (const [texts, name] of [
    [{ "a.vert": vertex, "a.frag": fragment }, "a.frag"],
    [{ "a.vert": vertex, "a.frag": fragment }, "a.vert"],
    [{ "a.vert.glsl": vertex, "a.frag.glsl": fragment }, "a.frag.glsl"],
    [{ "a-vert.glsl": vertex, "a-frag.glsl": fragment }, "a-frag.glsl"],
    [{ "aVertex.glsl": vertex, "aFragment.glsl": fragment }, "aVertex.glsl"],
    [{ "vertex.glsl": vertex, "fragment.glsl": fragment }, "fragment.glsl"],
    [{ "vs.glsl": vertex, "fs.glsl": fragment }, "fs.glsl"],
  ]) {
    const { module, watched } = await imported(texts, name);
    assert.match(module.vertex, /@vertex/);
    assert.match(module.fragment, /@fragment/);
    assert.equal(module.reflection.uniforms[0].name, "k");
    assert.deepEqual(watched, Object.keys(texts).sort());
  }
});

test("a source without a version is WebGL's, and an engine's if there is one", async () => {
  const old = { "a.vert": "attribute vec2 p;\nvoid main() { gl_Position = vec4(p, 0.0, 1.0); }\n", "a.frag": "precision mediump float;\nvoid main() { gl_FragColor = vec4(1.0); }\n" };
  const { module, errors } = await imported(old, "a.frag");
  assert.deepEqual(errors, []);
  assert.equal(module.reflection.attributes[0].name, "p");
  const three = { "a/vertex.glsl": "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }\n", "a/fragment.glsl": "void main() { gl_FragColor = vec4(1.0); }\n" };
  const found = await imported(three, "a/fragment.glsl", { options: { engine: "three" } });
  assert.deepEqual(found.errors, []);
  assert.ok(found.module.reflection.attributes.some(({ name, active }) => active && name === "position"));
});

test("files of the same path in two folders are two files", async () => {
  const part = (name) => `#include "c.glsl"\nfloat ${name}() { return ${name}c(); }\n`;
  const deep = (name) => `#include "d.glsl"\nfloat ${name}c() { return ${name}d(); }\n`;
  const texts = {
    "a.frag": '#version 150\n#include "x/m.glsl"\n#include "y/m.glsl"\nout vec4 c;\nvoid main() { c = vec4(x() + y()); }\n',
    "x/m.glsl": part("x"), "x/c.glsl": deep("x"), "x/d.glsl": "float xd() { return 0.25; }\n",
    "y/m.glsl": part("y"), "y/c.glsl": deep("y"), "y/d.glsl": "float yd() { return 0.5; }\n",
  };
  const { module, errors, watched } = await imported(texts, "a.frag");
  assert.deepEqual(errors, []);
  assert.match(module.fragment, /@fragment/);
  assert.deepEqual(watched, Object.keys(texts).sort());
});

test("errors have their file and line", async () => {
  const wrong = { "a.frag": '#version 150\n#include "f.glsl"\nout vec4 c;\nvoid main() { c = vec4(f()); }\n', "f.glsl": "float f() {\n    return x;\n}\n" };
  const { errors: [error] } = await imported(wrong, "a.frag");
  assert.ok(error.loc.file.endsWith("/f.glsl"), error.loc.file);
  assert.deepEqual([error.loc.line, error.loc.column], [2, 11]);
  assert.match(error.message, /`x` is not declared/);
});

test("folders are relative to the root, and what is watched has a whole path", async () => {
  const texts = { "src/a.frag": '#version 150\n#include "common.glsl"\nout vec4 c;\nvoid main() { c = tint(); }\n', "shaders/common.glsl": "vec4 tint() { return vec4(1.0); }\n" };
  const { module, errors, watched } = await imported(texts, "src/a.frag", { folders: ["shaders"] });
  assert.deepEqual(errors, []);
  assert.match(module.fragment, /@fragment/);
  assert.deepEqual(watched, Object.keys(texts).sort());
});

test("an error in another file than the imported one is told there, before warnings", async () => {
  const stages = { "a.vert": vertex, "a.frag": '#version 150\nin vec3 n;\nout vec4 c;\nvoid main() { c = vec4(n, 1.0); }\n' };
  const { errors: [between] } = await imported(stages, "a.vert");
  assert.ok(between.id.endsWith("/a.frag") && between.loc.file === between.id, between.id);
  assert.deepEqual([between.loc.line, between.loc.column], [2, 8]);
  const wrong = { "a.frag": '#version 150\n#include "f.glsl"\nout vec4 c;\nvoid main() { c = vec4(f()); }\n', "f.glsl": "float f() { return x; }\n" };
  const { errors: [error] } = await imported(wrong, "a.frag");
  assert.ok(error.id.endsWith("/f.glsl"), error.id);
  assert.match(error.message, /^`x` is not declared \(E0301\)\n/);
});

test("a file may have both stages", async () => {
  const both = "precision mediump float;\nvarying vec2 st;\n#ifdef VERTEX_SHADER\nattribute vec2 p;\nvoid main() { st = p; gl_Position = vec4(p, 0.0, 1.0); }\n#endif\n#ifdef FRAGMENT_SHADER\nuniform float k;\nvoid main() { gl_FragColor = vec4(st, k, 1.0); }\n#endif\n";
  const { module, watched } = await imported({ "screen.glsl": both }, "screen.glsl");
  assert.match(module.vertex, /@vertex/);
  assert.match(module.fragment, /@fragment/);
  assert.deepEqual(module.reflection.attributes.map(({ name }) => name), ["p"]);
  assert.deepEqual(watched, ["screen.glsl"]);
});

test("what tells no stage is refused", async () => {
  await assert.rejects(imported({ "a.glsl": fragment }, "a.glsl"), /the name `.*a\.glsl` tells no stage, and neither does the text/);
});
