// A plugin for Vite: `import program from "./x.frag?glisten"` is the code and the reflection of a program.
//
// A fragment shader brings the vertex shader of its stem, and the other way round: `wave.vert` and `wave.frag`, `wave/vertex.glsl` and
// `wave/fragment.glsl`. A source without a `#version` line is GLSL ES 1.00, as for WebGL. All files that went in are watched: with Vite,
// a change of an included file reloads what imports the program.

import { compile, GlistenError } from "glisten";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";

const SUFFIX = "?glisten";
/** Words that tell the stage: as an extension, or at an end of the name of a `.glsl` file. */
const WORDS = {
  vertex: ["vertexshader", "vertex", "vert", "vsh", "vs", "vp"],
  fragment: ["fragmentshader", "fragment", "frag", "fsh", "fs", "pixel", "fp", "ps"],
};

/** The stage that a file name tells, and the rest of the name: `wave` for `wave.frag`, `wave.frag.glsl`, `wave-frag.glsl`, `waveFrag.glsl`. */
function read(name) {
  const inner = name.replace(/\.glsl$/i, "");
  for (const [stage, words] of Object.entries(WORDS)) {
    for (const word of words) {
      const capital = word[0].toUpperCase() + word.slice(1);
      const signs = inner === name ? "\\." : "[._-]";
      const found = new RegExp(`^(.*)${signs}${word}$`, "i").exec(inner);
      if (found) return { stage, stem: found[1] };
      if (inner === name) continue;
      if (inner.toLowerCase() === word) return { stage, stem: "" };
      const other = new RegExp(`^${word}[._-](.*)$`, "i").exec(inner) ?? new RegExp(`^(.*[a-z0-9])${capital}$`).exec(inner);
      if (other) return { stage, stem: other[1] };
    }
  }
  return null;
}

/** The files of the program of a file: the other stage has the same stem, in the same folder. */
function filesOf(file) {
  const own = read(basename(file));
  if (!own) return [file];
  const isOther = (name) => {
    const found = read(name);
    return found !== null && found.stage !== own.stage && found.stem === own.stem;
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
        return { name, text: readFileSync(name, "utf8"), stage: read(basename(name))?.stage };
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
