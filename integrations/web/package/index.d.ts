/** A stage of a program. */
export type Stage = "vertex" | "geometry" | "fragment";
/** A language to write; `msl` and `hlsl` with `glisten/reference` alone. `glsl` is GLSL ES 3.00, unless the option `glslVersion` says otherwise. */
export type Target = "wgsl" | "spirv" | "msl" | "hlsl" | "glsl";
/**
 * A source of a program. `stage` tells the stage, or else the name does (`a.vert`, `a.frag`). A text whose name tells none has the stages that macros choose in
 * it (`#ifdef VERTEX_SHADER`).
 */
export interface Source {
  name: string;
  text: string;
  stage?: Stage;
}
/** Sources in order, or texts by their names. */
export type Sources = readonly Source[] | Readonly<Record<string, string>> | ReadonlyMap<string, string>;
/**
 * The text of an included file, with a name that tells it from others of the same path: the name is `from` for what the file
 * includes, and is in diagnostics. Without a name, it is the path. Nothing where the library is to be asked.
 */
export type Include = (
  path: string,
  angled: boolean,
  from: string,
) => string | { name: string; text: string } | null | undefined;

/** Options of all calls that compile. */
export interface Options {
  /** Included files by their names, or a function that is asked for each. */
  includes?: Readonly<Record<string, string>> | ReadonlyMap<string, string> | Include;
  /** Macros; `true` is 1, as `-D NAME` is. */
  defines?: Readonly<Record<string, string | number | true>>;
  /** Locations of vertex attributes, as `glBindAttribLocation` sets them. */
  attributes?: Readonly<Record<string, number>>;
  /** Color numbers of fragment outputs, as `glBindFragDataLocation` sets them. */
  outputs?: Readonly<Record<string, number>>;
  /** Flags of `glisten compile`: `clipZ` is `--clip-z`. */
  options?: Flags;
}
/** Flags of `glisten compile`; `prelude` is the text, not a file. */
export interface Flags {
  allow?: string | readonly string[];
  warn?: string | readonly string[];
  deny?: string | readonly string[];
  /** Completes sources as this engine does: `three` gives what a `ShaderMaterial` has. The names are those of `glisten compile --engine`. */
  engine?: string;
  assumeVersion?: string;
  clipDistances?: number;
  clipZ?: "zero-to-one" | "minus-one-to-one";
  debugLines?: boolean;
  floats?: "f16" | "f32" | "f64";
  includeStyle?: string;
  glslVersion?: "330" | "450" | "300es" | "vulkan";
  optimize?: boolean;
  pointSprites?: boolean;
  /** Texts before each source. */
  prelude?: string | readonly string[];
  programPointSize?: boolean;
  spirvEnv?: "webgpu" | "vulkan";
  strict?: boolean;
  windowOrigin?: "upper-left" | "lower-left";
}

/** A place in a source; lines and columns count from 1, the end is exclusive. */
export interface Region {
  file: string;
  line: number;
  column: number;
  end_line: number;
  end_column: number;
}
/** A change of texts. */
export interface Fix {
  title: string;
  applicability: "safe" | "unsafe";
  edits: { file: string; start: { line: number; column: number }; end: { line: number; column: number }; text: string }[];
}
/** What was found, as `glisten lint --format json` writes it. */
export interface Diagnostic extends Region {
  severity: string;
  code: string;
  name: string;
  message: string;
  help: string | null;
  fixes: Fix[];
  labels: (Region & { message: string })[];
  notes: string[];
  section: string | null;
  presented_line: number | null;
}

/** What a call throws. Errors in sources are in `diagnostics`. */
export declare class GlistenError extends Error {
  readonly kind: "argument" | "content" | "file" | "internal";
  readonly diagnostics: Diagnostic[];
}

/** The code of a stage: bytes for SPIR-V, else a text. */
export type Code = { [T in Target]?: T extends "spirv" ? Uint8Array : string };
/** The reflection of a program: docs/reflection.schema.json in glisten's repository. */
export interface Reflection {
  [key: string]: unknown;
}
export interface Compiled {
  stages: { [S in Stage]?: Code };
  reflection: Reflection | null;
  /** Warnings. */
  diagnostics: Diagnostic[];
}

/** Loads the module. Browsers call it once before all else; Node needs no call. */
export declare function init(from?: URL | string | Response | BufferSource | WebAssembly.Module): Promise<void>;
/** Compiles the sources of one program. */
export declare function compile(
  sources: Sources,
  options?: Options & { target?: Target | readonly Target[]; reflect?: boolean },
): Compiled;
/** Finds what is wrong, and what is legal but will hurt. */
export declare function lint(sources: Sources, options?: Options): { sound: boolean; diagnostics: Diagnostic[]; text: string };
/** Applies the safe fixes, or all of them, until nothing changes. */
export declare function fix(
  sources: Sources,
  options?: Options & { unsafe?: boolean },
): { texts: Record<string, string>; applied: number; sound: boolean; diagnostics: Diagnostic[] };
/** What a host needs to know of a program. */
export declare function reflect(sources: Sources, options?: Options): Reflection;
/** Rewrites old sources: `150`, `330`, `450`, `460`, `300es` and the others of `versions().upgrades`. */
export declare function upgrade(
  sources: Sources,
  to: string,
  options?: Options,
): { texts: Record<string, string>; notes: string[] };
/** Formats a text as `glisten fmt` does. An `indent` of 0 is tabs. */
export declare function format(
  text: string,
  options?: { name?: string; stage?: Stage; indent?: number; width?: number; bracesBelow?: boolean },
): string;
/**
 * The stage that the name of a file tells, and the name without the part that tells it, which the other stages of a program share:
 * `wave` for `wave.frag`, `wave.frag.glsl` and `waveFrag.glsl`. Null where the name tells none.
 */
export declare function stageOf(name: string): { stage: Stage; stem: string } | null;
/** The version, and the words that calls take. */
export declare function versions(): {
  version: string;
  targets: Target[];
  options: string[];
  upgrades: string[];
  reference: boolean;
};
