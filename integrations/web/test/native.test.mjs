// The package gives the same bytes as the native program.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { compiler, files, native, programs, reference, root } from "./package.mjs";

test("the WGSL of all programs of the fixtures is the same", () => {
  let compared = 0;
  for (const folder of ["fixtures/programs", "fixtures/lower", "fixtures/valid"]) {
    const texts = Object.entries(files(folder)).filter(([name]) => name.endsWith(".glsl"));
    const includes = Object.fromEntries(texts.map(([name, bytes]) => [name, bytes.toString()]));
    for (const [stem, sources] of programs(folder)) {
      const read = (out) => Object.fromEntries(readdirSync(out).map((name) => [name, readFileSync(join(out, name))]));
      const told = native(["compile", ...sources.map(({ name }) => name), "--target", "wgsl", "--target", "spirv", "-o", "OUT"], read);
      let own = null;
      try {
        own = compiler.compile(sources.map(({ name, text }) => ({ name, text })), { target: ["wgsl", "spirv"], includes });
      } catch (error) {
        assert.ok(error instanceof compiler.GlistenError && error.kind !== "internal", `${stem}: ${error}`);
      }
      assert.equal(own !== null, told.status === 0, `${folder}/${stem}: ${told.stderr}`);
      if (!own) continue;
      for (const { name, extension } of sources) {
        const stage = { vert: "vertex", frag: "fragment", geom: "geometry" }[extension];
        const file = (ending) => told.read[Object.keys(told.read).find((file) => file.endsWith(`.${extension}.${ending}`))];
        assert.equal(own.stages[stage].wgsl, file("wgsl").toString(), name);
        // naga orders local variables by a hash that depends on the size of a pointer.
        assert.equal(own.stages[stage].spirv.length, file("spv").length, name);
        compared += 1;
      }
    }
  }
  assert.ok(compared >= 40, `${compared} stages`);
});

test("the reference draws the same bits", () => {
  const all = files("fixtures/scenes", "fixtures/programs", "fixtures/trace");
  const scenes = Object.keys(all).filter((name) => /^fixtures\/(scenes|trace)\/[^/]*\.toml$/.test(name));
  let compared = 0;
  for (const scene of scenes) {
    const told = native(["render", scene, "--backend", "cpu", "-o", "OUT/a.npy"], (out) => {
      try {
        return readFileSync(join(out, "a.npy"));
      } catch {
        return null;
      }
    });
    if (!told.read) {
      assert.throws(() => reference.render(scene, all), reference.GlistenError, `${scene}: the program says ${told.stderr}`);
      continue;
    }
    const { width, height, attachments } = reference.render(scene, all, { floats: true });
    const header = told.read.readUInt16LE(8) + 10;
    const floats = new Float32Array(told.read.buffer.slice(told.read.byteOffset + header, told.read.byteOffset + told.read.length));
    assert.equal(floats.length, width * height * 4, scene);
    const differs = floats.findIndex((value, index) => !Object.is(value, Math.fround(attachments[0][index])));
    assert.equal(differs, -1, `${scene}: number ${differs}: ${floats[differs]}, ${attachments[0][differs]}`);
    compared += 1;
  }
  assert.ok(compared >= 8, `${compared} of ${scenes.length} scenes in ${root}`);
});
