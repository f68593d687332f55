// A plugin for Vite: `import program from "./x.frag?glisten"` is the code and the reflection of a program.
//
// A fragment shader brings the vertex shader of its stem, and the other way round. All files that went in are watched: with Vite,
// a change of an included file reloads what imports the program.

import { compile, GlistenError } from "glisten";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";

const SUFFIX = "?glisten";
const VERTEX = ["vert", "vs", "vsh"];
const FRAGMENT = ["frag", "fs", "fsh"];

/** The files of the program of a file. */
function filesOf(file) {
  const [, stem, extension, tail] = /^(.*?)\.([a-z]+)(\.glsl)?$/.exec(file) ?? [];
  const others = VERTEX.includes(extension) ? FRAGMENT : FRAGMENT.includes(extension) ? VERTEX : [];
  const other = others.map((one) => `${stem}.${one}${tail ?? ""}`).find(existsSync);
  if (!other) return [file];
  return VERTEX.includes(extension) ? [file, other] : [other, file];
}

export default function glisten(given = {}) {
  const { target = "wgsl", folders = [], ...options } = given;
  return {
    name: "glisten",
    enforce: "pre",
    async resolveId(id, importer) {
      if (!id.endsWith(SUFFIX)) return null;
      const file = id.slice(0, -SUFFIX.length);
      const found = this.resolve ? await this.resolve(file, importer, { skipSelf: true }) : null;
      const path = found?.id ?? resolve(importer ? dirname(importer) : ".", file);
      return path.split("?")[0] + SUFFIX;
    },
    async load(id) {
      if (!id.endsWith(SUFFIX)) return null;
      const files = filesOf(id.slice(0, -SUFFIX.length));
      const sources = files.map((name) => {
        this.addWatchFile(name);
        return { name, text: readFileSync(name, "utf8") };
      });
      const includes = (path, angled, from) => {
        const found = [...(angled ? [] : [dirname(from)]), ...folders].map((folder) => join(folder, path)).find(existsSync);
        if (!found) return null;
        this.addWatchFile(found);
        return { name: found, text: readFileSync(found, "utf8") };
      };
      let program;
      try {
        program = compile(sources, { ...options, target, includes });
      } catch (error) {
        const at = error instanceof GlistenError ? error.diagnostics.find((one) => one.severity === "error") : undefined;
        if (!at) throw error;
        return this.error({ message: error.message, id, loc: { file: at.file, line: at.line, column: at.column - 1 } });
      }
      program.diagnostics.forEach((one) => this.warn(`${one.file}:${one.line}:${one.column}: ${one.message} (${one.code})`));
      const code = Object.entries(program.stages).map(([stage, byTarget]) => [stage, byTarget[target]]);
      return `export default ${JSON.stringify({ ...Object.fromEntries(code), reflection: program.reflection })};`;
    },
  };
}
