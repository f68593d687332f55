export * from "./index.js";
import type { Options } from "./index.js";

/** A picture, top row first. It has what `ImageData` has. */
export interface Picture<Pixels> {
  width: number;
  height: number;
  /** RGBA of the first attachment. */
  data: Pixels;
  attachments: Pixels[];
  /** 1 where a fragment was written. */
  covered: Uint8Array;
}
/** The files of a scene by their names: the scene, its shaders, models, textures. */
export type Files = Readonly<Record<string, string | Uint8Array>> | ReadonlyMap<string, string | Uint8Array>;

/** Draws the scene at a path of `files` with the reference. */
export declare function render(
  path: string,
  files: Files,
  options: Options & { precision?: "f64" | "f32"; floats: true },
): Picture<Float64Array>;
export declare function render(
  path: string,
  files: Files,
  options?: Options & { precision?: "f64" | "f32"; floats?: false },
): Picture<InstanceType<Uint8ClampedArrayConstructor>>;
