// The functions of the package, for a module that is there.

import { GlistenError } from "./module.js";

const dashed = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
const list = (value) => (Array.isArray(value) ? value : [value]);

function optionsOf(options) {
  const pairs = [];
  for (const [name, value] of Object.entries(options.options ?? {}))
    for (const one of value === undefined ? [] : list(value)) pairs.push([dashed(name), String(one)]);
  return {
    options: pairs,
    defines: Object.entries(options.defines ?? {}).map(([name, value]) => [name, value === true ? "1" : String(value)]),
    attributes: Object.entries(options.attributes ?? {}),
    outputs: Object.entries(options.outputs ?? {}),
    includes: typeof options.includes === "object" ? entries(options.includes) : {},
  };
}

const entries = (map) => (map instanceof Map ? Object.fromEntries(map) : (map ?? {}));

function sourcesOf(sources) {
  if (Array.isArray(sources)) return sources;
  return Object.entries(entries(sources)).map(([name, text]) => ({ name, text }));
}

function told(reply) {
  return JSON.parse(reply.diagnostics || "[]");
}

/** The functions on this module. */
export function api(module) {
  const call = (name, sources, options, rest) =>
    module.asked({ call: name, sources: sourcesOf(sources), ...optionsOf(options), ...rest }, options.includes);

  function compile(sources, options = {}) {
    const targets = list(options.target ?? "wgsl");
    const given = targets.includes("glsl") ? { glslVersion: "300es", ...options.options } : options.options;
    const asked = { targets, reflect: options.reflect !== false };
    const reply = call("compile", sources, { ...options, options: given }, asked);
    const diagnostics = told(reply);
    if (!reply.sound) throw new GlistenError(reply.human.trimEnd(), "content", diagnostics);
    const stages = {};
    for (const [stage, byTarget] of Object.entries(reply.code)) {
      stages[stage] = {};
      for (const [target, place] of Object.entries(byTarget)) {
        const bytes = reply.bytes(place);
        stages[stage][target] = target === "spirv" ? bytes : new TextDecoder().decode(bytes);
      }
    }
    return { stages, reflection: reply.reflection ? JSON.parse(reply.reflection) : null, diagnostics };
  }

  function lint(sources, options = {}) {
    const reply = call("compile", sources, options, { lints: true });
    return { sound: reply.sound, diagnostics: told(reply), text: reply.human };
  }

  function fix(sources, options = {}) {
    const given = sourcesOf(sources);
    const reply = call("fix", given, options, { unsafe_fixes: options.unsafe === true });
    const texts = Object.fromEntries(given.map(({ name }, i) => [name, reply.texts[i]]));
    return { texts, applied: reply.applied, sound: reply.sound, diagnostics: told(reply) };
  }

  function reflect(sources, options = {}) {
    return compile(sources, { ...options, target: [], reflect: true }).reflection;
  }

  function upgrade(sources, to, options = {}) {
    const given = sourcesOf(sources);
    const reply = call("upgrade", given, options, { to });
    if (!reply.sound) throw new GlistenError(reply.human.trimEnd(), "content", told(reply));
    return { texts: Object.fromEntries(given.map(({ name }, i) => [name, reply.texts[i]])), notes: reply.notes };
  }

  function format(text, options = {}) {
    const { name = "text.frag", stage, indent, width, bracesBelow } = options;
    const style = { indent, width, braces_below: bracesBelow === true };
    return module.call({ call: "format", sources: [{ name, text, stage }], style }).texts[0];
  }

  function stageOf(name) {
    return module.call({ call: "names", sources: [{ name, text: "" }] }).names[0];
  }

  function versions() {
    const { version, targets, options, upgrades, reference } = module.call({ call: "versions" });
    return { version, targets, options, upgrades, reference };
  }

  function render(path, files, options = {}) {
    const [places, parts, encoder] = [{}, [], new TextEncoder()];
    let length = 0;
    for (const [name, content] of Object.entries(entries(files))) {
      const bytes = typeof content === "string" ? encoder.encode(content) : content;
      places[name] = [length, bytes.length];
      parts.push(bytes);
      length += bytes.length;
    }
    const blob = new Uint8Array(length);
    let at = 0;
    for (const part of parts) {
      blob.set(part, at);
      at += part.length;
    }
    const request = { call: "render", path, files: places, to: options.precision ?? "f64", floats: options.floats === true };
    const reply = module.asked({ ...request, ...optionsOf(options) }, options.includes, blob);
    if (!reply.sound) throw new GlistenError(reply.human.trimEnd(), "content", told(reply));
    const { width, height } = reply;
    const attachments = reply.attachments.map((place) => {
      const bytes = reply.bytes(place);
      return options.floats ? new Float64Array(bytes.buffer) : new Uint8ClampedArray(bytes.buffer);
    });
    return { width, height, data: attachments[0], attachments, covered: reply.bytes(reply.covered) };
  }

  return { compile, lint, fix, reflect, upgrade, format, stageOf, versions, render };
}
