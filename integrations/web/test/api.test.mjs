// Each function of the package, and what it says of wrong input.

import assert from "node:assert/strict";
import { test } from "node:test";
import { compiler, reference } from "./package.mjs";

const VERTEX = "#version 150\nin vec2 p;\nout vec2 at;\nvoid main() { at = p; gl_Position = vec4(p, 0.0, 1.0); }\n";
const FRAGMENT = "#version 150\nuniform vec4 tint;\nin vec2 at;\nout vec4 color;\nvoid main() { color = tint * vec4(at, 0.0, 1.0); }\n";
const program = { "a.vert": VERTEX, "a.frag": FRAGMENT };

test("compile gives the code of each stage and the reflection", () => {
  const { stages, reflection, diagnostics } = compiler.compile(program, { target: ["wgsl", "spirv", "glsl"] });
  assert.deepEqual(Object.keys(stages).sort(), ["fragment", "vertex"]);
  assert.match(stages.vertex.wgsl, /@vertex/);
  assert.match(stages.fragment.glsl, /^#version 300 es/);
  assert.deepEqual([...stages.fragment.spirv.slice(0, 4)], [3, 2, 0x23, 7]);
  assert.equal(reflection.uniforms[0].name, "tint");
  assert.deepEqual(diagnostics, []);
  assert.equal(compiler.reflect(program).attributes[0].name, "p");
});

test("errors are thrown with their places", () => {
  const wrong = { "a.frag": "#version 150\nout vec4 c;\nvoid main() { c = mixx(c); }\n" };
  assert.throws(() => compiler.compile(wrong), (error) => {
    assert.ok(error instanceof compiler.GlistenError);
    const [{ code, line, help }] = error.diagnostics;
    assert.deepEqual([error.kind, code, line, help], ["content", "E0304", 3, "did you mean `mix`?"]);
    return true;
  });
  assert.throws(() => compiler.compile({ "a.txt": "" }), { kind: "argument" });
  assert.throws(() => compiler.compile(program, { target: "cobol" }), { kind: "argument" });
});

test("an engine and preludes complete sources", () => {
  const material = {
    "a.vert": "varying vec2 at;\nvoid main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }\n",
    "a.frag": "varying vec2 at;\nuniform vec3 tint;\nvoid main() { gl_FragColor = vec4(tint * at.xyx, 1.0); }\n",
  };
  const { reflection } = compiler.compile(material, { options: { engine: "three" } });
  assert.deepEqual(reflection.attributes.filter(({ active }) => active).map(({ name }) => name).sort(), ["position", "uv"]);
  assert.throws(() => compiler.compile(material), { kind: "content" });
  assert.throws(() => compiler.compile(material, { options: { engine: "tree" } }), /did you mean `three`/);
  // A chunk of three.js, which the host has in memory.
  const chunk = { "a.frag": "#include <half>\nvoid main() { gl_FragColor = vec4(half_of(1.0)); }\n" };
  const includes = (path) => (path === "half" ? "float half_of(float x) { return 0.5 * x; }\n" : null);
  assert.match(compiler.compile(chunk, { options: { engine: "three" }, includes }).stages.fragment.wgsl, /@fragment/);
  const bare = { "a.frag": "void main() { c = vec4(k); }\n" };
  const options = { assumeVersion: "150", prelude: ["uniform float k;", "out vec4 c;"] };
  assert.equal(compiler.compile(bare, { options }).reflection.uniforms[0].name, "k");
});

test("lint finds, and fix mends", () => {
  const old = { "a.frag": "#version 150\nout vec4 c;\nin vec2 uv;\nuniform sampler2D t;\nvoid main() { c = texture2D(t, uv); }\n" };
  const found = compiler.lint(old);
  assert.ok(found.diagnostics.some((one) => one.fixes.length > 0), found.text);
  const { texts, applied } = compiler.fix(old);
  assert.ok(applied > 0);
  assert.match(texts["a.frag"], /texture\(t, uv\)/);
  assert.equal(compiler.fix(texts).applied, 0);
});

test("includes come from a map, from a function and from the library", () => {
  const source = (path) => ({ "a.frag": `#version 150\n#include ${path}\nout vec4 c;\nvoid main() { c = vec4(f()); }\n` });
  const text = "float f() { return 0.5; }\n";
  const wgsl = (options) => compiler.compile(source('"lib/f.glsl"'), options).stages.fragment.wgsl;
  assert.equal(wgsl({ includes: { "lib/f.glsl": text } }), wgsl({ includes: () => text }));
  assert.throws(() => wgsl({ includes: () => null }), { kind: "content" });
  const lit = "#version 150\n#include <glisten/lambert.glsl>\nout vec4 c;\nvoid main() { c = vec4(lambertFactor(vec3(0, 0, 1), vec3(0, 0, 1))); }\n";
  assert.match(compiler.compile({ "a.frag": lit }).stages.fragment.wgsl, /lambertFactor/);
});

test("MSL, HLSL and GLSL for Vulkan come with the reference", () => {
  for (const target of ["msl", "hlsl"]) {
    assert.throws(() => compiler.compile(program, { target }), { kind: "argument", message: /only the module with the reference writes/ });
    assert.ok(reference.compile(program, { target }).stages.fragment[target].includes("main"));
  }
  const old = { "a.frag": "#version 150\nuniform float k;\nout vec4 c;\nvoid main() { c = vec4(k); }\n" };
  assert.throws(() => compiler.upgrade(old, "vulkan"), /only the module with the reference writes/);
  assert.match(reference.upgrade(old, "vulkan").texts["a.frag"], /layout\(.*binding/);
  assert.deepEqual(reference.versions().targets.filter((target) => !compiler.versions().targets.includes(target)), ["msl", "hlsl"]);
  assert.deepEqual(reference.versions().upgrades.filter((word) => !compiler.versions().upgrades.includes(word)), ["vulkan"]);
});

test("names tell stages, and texts do where names do not", () => {
  assert.deepEqual(compiler.stageOf("shaders/waveFrag.glsl"), { stage: "fragment", stem: "wave" });
  assert.equal(compiler.stageOf("wave.glsl"), null);
  const both = "#version 150\n#ifdef VERTEX\nvoid main() { gl_Position = vec4(0.0); }\n#else\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n#endif\n";
  assert.deepEqual(Object.keys(compiler.compile({ "a.glsl": both }).stages).sort(), ["fragment", "vertex"]);
  // What stages share is told once.
  const wrong = both.replace("#ifdef", "float f() { return nothing; }\n#ifdef");
  assert.equal(compiler.lint({ "a.glsl": wrong }).diagnostics.filter(({ severity }) => severity === "error").length, 1);
  assert.throws(() => compiler.compile({ "a.glsl": "void main() {}" }), { kind: "argument", message: /tells no stage, and neither does the text/ });
});

test("upgrade and format rewrite texts", () => {
  const old = { "a.frag": "#version 120\nvarying vec2 u;\nvoid main() { gl_FragColor = vec4(u, 0.0, 1.0); }\n" };
  assert.match(compiler.upgrade(old, "330").texts["a.frag"], /#version 330 core[^]*in vec2 u;/);
  assert.equal(compiler.format("void main(){int x;}\n", { indent: 2 }), "void main() { int x; }\n");
  assert.throws(() => compiler.format("", { width: 1 }), { kind: "argument" });
});

test("hostile input is an error, and the next call works", () => {
  const deep = `#version 150\nvoid main() { float x = ${"(".repeat(200_000)}1.0; }\n`;
  const long = `#version 150\nvoid main() {\n${"float x;\n".repeat(100_000)}}\n`;
  for (const text of [deep, long, "\0\ud800", "#version 150\n#define f(x) f(f(x)) f(f(x))\nf(f(f(f(f(f(f(f(1))))))))\n", "\xff\xfe"]) {
    assert.throws(() => compiler.compile({ "a.frag": text }), compiler.GlistenError);
    assert.match(compiler.compile(program).stages.vertex.wgsl, /@vertex/);
  }
});

test("a chain that the engine has no stack for is an error of the source", () => {
  const long = `#version 150\nuniform float u;\nout vec4 c;\nvoid main() { c = vec4(u${" + u".repeat(16_000)}); }\n`;
  try {
    // An engine may have stack enough.
    assert.match(compiler.compile({ "a.frag": long }).stages.fragment.wgsl, /@fragment/);
  } catch (error) {
    const [{ code, file }] = error.diagnostics;
    assert.deepEqual([error.kind, code, file], ["content", "E0003", "a.frag"]);
  }
  assert.match(compiler.compile(program).stages.vertex.wgsl, /@vertex/);
});

test("an option that is undefined is none, and a macro that is true is 1", () => {
  const asked = { "a.frag": "#version 150\nout vec4 c;\n#if A\nvoid main() { c = vec4(1.0); }\n#endif\n" };
  assert.ok(compiler.compile(asked, { defines: { A: true }, options: { clipZ: undefined } }).stages.fragment);
});

const scene = "[framebuffer]\nwidth = 8\nheight = 4\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangle_strip\"\n" +
  "[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n[draw.uniforms]\ntint = [1, 0.5, 0, 1]\n";

test("render draws what ImageData takes", () => {
  const picture = reference.render("a.toml", { "a.toml": scene, ...program });
  assert.deepEqual([picture.width, picture.height, picture.data.constructor, picture.data.length], [8, 4, Uint8ClampedArray, 128]);
  assert.ok(picture.covered.every((covered) => covered === 1));
  // The pixel at the right edge in the middle: at.x is 0.875.
  assert.equal(picture.data[4 * (8 + 7)], Math.round(0.875 * 255));
  assert.throws(() => reference.render("b.toml", { "a.toml": scene }), reference.GlistenError);
});

test("a loop without an end is an error, and the next picture is drawn", () => {
  const endless = FRAGMENT.replace("{ color", "{ while (at.x < 9.0) ; color");
  assert.throws(() => reference.render("a.toml", { "a.toml": scene, "a.vert": VERTEX, "a.frag": endless }), (error) => {
    assert.deepEqual([error.kind, error.diagnostics.map(({ code, file }) => [code, file])], ["content", [["E0913", "a.frag"]]]);
    return true;
  });
  assert.equal(reference.render("a.toml", { "a.toml": scene, ...program }).width, 8);
});
