// The package that `integrations/web/make` made: where it is, and the native program that it is compared with.

import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
export const folder = resolve(process.env.GLISTEN_WEB ?? join(root, "target/web/package"));
const program = resolve(process.env.GLISTEN ?? join(root, "target/debug/glisten"));

const load = (file) => import(pathToFileURL(join(folder, file)).href);
export const compiler = await load("node.js");
export const reference = await load("reference-node.js");
export const vite = join(folder, "vite.js");

/** What the native program prints; its files are in a folder that `read` sees. */
export function native(args, read = () => undefined) {
  const out = mkdtempSync(join(tmpdir(), "glisten-"));
  try {
    const ran = spawnSync(program, args.map((arg) => arg.replace("OUT", out)), { cwd: root, encoding: "utf8" });
    if (ran.error) throw ran.error;
    return { ...ran, read: read(out) };
  } finally {
    rmSync(out, { recursive: true });
  }
}

/** The programs of a folder of fixtures: sources by stem. */
export function programs(name) {
  const found = new Map();
  for (const file of readdirSync(join(root, name), { recursive: true })) {
    const [, stem, extension] = /^(.*)\.(vert|frag|geom)$/.exec(file) ?? [];
    if (!stem) continue;
    const path = join(name, file);
    const text = readFileSync(join(root, path), "utf8");
    found.set(stem, [...(found.get(stem) ?? []), { name: path, text, extension }]);
  }
  return found;
}

/** The files under a folder by their paths from the root. */
export function files(...names) {
  const found = {};
  for (const name of names.filter((name) => existsSync(join(root, name)))) {
    for (const entry of readdirSync(join(root, name), { recursive: true, withFileTypes: true })) {
      if (!entry.isFile()) continue;
      const path = join(entry.parentPath ?? entry.path, entry.name);
      found[path.slice(root.length).replace(/^\//, "")] = readFileSync(path);
    }
  }
  return found;
}
