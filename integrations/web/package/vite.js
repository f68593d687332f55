// A plugin for Vite: `import program from "./x.frag?glisten"` is the code and the reflection of a program.
//
// A fragment shader brings the vertex shader of its stem, and the other way round: `wave.vert` and `wave.frag`, `wave/vertex.glsl` and
// `wave/fragment.glsl`. A file with both, chosen by macros, is a program of its own. A source without a `#version` line is GLSL ES 1.00, as for WebGL. All files that went in are watched: with Vite,
// a change of an included file reloads what imports the program.

import { compile, GlistenError, stageOf } from "glisten";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";

const SUFFIX = "?glisten";

/** The files of the program of a file: the other stage has the same stem, in the same folder. A file whose name tells no stage is a program. */
function filesOf(file) {
  const own = stageOf(basename(file));
  if (!own) return [file];
  const isOther = (name) => {
    const found = stageOf(name);
    return found !== null && found.stage !== own.stage && found.stage !== "geometry" && found.stem === own.stem;
  };
  const [other] = readdirSync(dirname(file)).filter(isOther).sort();
  if (!other) return [file];
  const path = join(dirname(file), other);
  return own.stage === "vertex" ? [file, path] : [path, file];
}

export default function glisten(given = {}) {
  const { target = "wgsl", folders = [], ...rest } = given;
  // A source without a `#version` line is WebGL's, unless an engine says otherwise (WebGL 1.0 §4.3: GLSL ES 1.00).
  const { assumeVersion = rest.options?.engine ? undefined : "100", ...flags } = rest.options ?? {};
  const options = { ...rest, options: assumeVersion === undefined ? flags : { ...flags, assumeVersion } };
  let searched = folders.map((folder) => resolve(folder));
  return {
    name: "glisten",
    enforce: "pre",
    /** Folders are relative to Vite's root; Rollup has none, and they are relative to the working folder. */
    configResolved({ root }) {
      searched = folders.map((folder) => resolve(root, folder));
    },
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
        const found = [...(angled ? [] : [dirname(from)]), ...searched].map((folder) => join(folder, path)).find(existsSync);
        if (!found) return null;
        this.addWatchFile(found);
        return { name: found, text: readFileSync(found, "utf8") };
      };
      let program;
      try {
        program = compile(sources, { ...options, target, includes });
      } catch (error) {
        const all = error instanceof GlistenError ? error.diagnostics : [];
        const at = all.find((one) => one.severity === "error");
        if (!at) throw error;
        // The first line, which is what a terminal and a browser show first, is that of the error.
        const message = at === all[0] ? error.message : `${at.message} (${at.code})\n\n${error.message}`;
        // The place is in a file of the program, which need not be the one that is imported. Columns of Rollup count from 0.
        const file = resolve(at.file);
        return this.error({ message, id: file, loc: { file, line: at.line, column: at.column - 1 } });
      }
      program.diagnostics.forEach((one) => this.warn(`${one.file}:${one.line}:${one.column}: ${one.message} (${one.code})`));
      const code = Object.entries(program.stages).map(([stage, byTarget]) => [stage, byTarget[target]]);
      return `export default ${JSON.stringify({ ...Object.fromEntries(code), reflection: program.reflection })};`;
    },
  };
}
