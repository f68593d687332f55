import type { Options, Reflection, Target } from "./index.js";

/** What `import program from "./x.frag?glisten"` is. */
export interface ImportedProgram {
  vertex?: string;
  geometry?: string;
  fragment?: string;
  reflection: Reflection;
}
/** A plugin for Vite and for Rollup. */
export interface GlistenPlugin {
  name: string;
  enforce: "pre";
  configResolved(config: { root: string }): void;
  resolveId(id: string, importer?: string): Promise<string | null>;
  load(id: string): Promise<string | null>;
}
/** The plugin. Included files are looked for next to the including one, then in `folders`, which are relative to Vite's root. */
export default function glisten(
  options?: Omit<Options, "includes"> & { target?: Exclude<Target, "spirv">; folders?: readonly string[] },
): GlistenPlugin;
