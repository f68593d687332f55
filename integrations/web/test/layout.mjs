// Reads WGSL as a host would: where the uniforms of a text are, by the layout rules of WGSL (§14.4), and which resources it has.

const up = (value, to) => Math.ceil(value / to) * to;

/** The parts of `a, b<c, d>` between its own commas. */
function parts(text) {
  const found = [""];
  let depth = 0;
  for (const sign of text) {
    if ("<(".includes(sign)) depth += 1;
    if (">)".includes(sign)) depth -= 1;
    if (sign === "," && depth === 0) found.push("");
    else found[found.length - 1] += sign;
  }
  return found.map((part) => part.trim()).filter(Boolean);
}

/** The structs of a text: members with their types, in order. */
function structsOf(text) {
  const structs = new Map();
  for (const [, name, body] of text.replace(/\/\/.*/g, "").matchAll(/struct\s+(\w+)\s*\{([^}]*)\}/g)) {
    const members = parts(body).map((member) => {
      const [, attributes, own, type] = /^((?:@\w+\([^)]*\)\s*)*)(\w+)\s*:\s*(.*)$/s.exec(member);
      const number = (word) => Number(new RegExp(`@${word}\\((\\d+)`).exec(attributes)?.[1] ?? 0);
      return { name: own, type, size: number("size"), align: number("align") };
    });
    structs.set(name, members);
  }
  return structs;
}

/** The layout of a type: its alignment and size in bytes, and where its members or elements are. */
function layoutOf(type, structs) {
  const vector = /^vec([234])(?:<\w+>|[fiu])$/.exec(type);
  if (vector) return { align: vector[1] === "2" ? 8 : 16, size: 4 * Number(vector[1]) };
  const matrix = /^mat([234])x([234])(?:<f32>|f)$/.exec(type);
  if (matrix) {
    const column = matrix[2] === "2" ? 8 : 16;
    return { align: column, size: Number(matrix[1]) * column };
  }
  const array = /^array<(.*)>$/s.exec(type);
  if (array) {
    const [element, count] = parts(array[1]);
    const inner = layoutOf(element, structs);
    const stride = up(inner.size, inner.align);
    return { align: inner.align, size: stride * Number(count), stride, inner };
  }
  const members = structs.get(type);
  if (!members) return { align: 4, size: 4 };
  let [offset, align] = [0, 1];
  const places = new Map();
  for (const member of members) {
    const own = layoutOf(member.type, structs);
    const aligned = Math.max(own.align, member.align);
    offset = up(offset, aligned);
    places.set(member.name, { offset, layout: own });
    offset += Math.max(own.size, member.size);
    align = Math.max(align, aligned);
  }
  return { align, size: up(offset, align), places };
}

/** The resources of a text by `group.binding`: their names, types, and layouts for uniform blocks. */
export function resourcesOf(text) {
  const structs = structsOf(text);
  const found = new Map();
  for (const [, group, binding, space, name, type] of text.matchAll(/@group\((\d+)\)\s*@binding\((\d+)\)\s*var(<\w+>)?\s+(\w+)\s*:\s*([^;]+);/g)) {
    found.set(`${group}.${binding}`, { name, type: type.trim(), layout: space ? layoutOf(type.trim(), structs) : null });
  }
  return found;
}

/** The place of `a.b[1].c` in a layout: offset and layout; null if it is not there. */
function placeOf(path, layout) {
  let [offset, at] = [0, layout];
  for (const [, name, index] of path.matchAll(/(\w+)|\[(\d+)\]/g)) {
    if (name !== undefined) {
      const place = at.places?.get(name);
      if (!place) return null;
      offset += place.offset;
      at = place.layout;
    } else {
      if (at.stride === undefined) return null;
      offset += Number(index) * at.stride;
      at = at.inner;
    }
  }
  return { offset, layout: at };
}

/** What a reflection says otherwise than the texts of its stages: sentences; and how many uniforms and resources were compared. */
export function compared(reflection, texts) {
  const complaints = [];
  let count = 0;
  const resources = texts.map(resourcesOf);
  const having = (group, binding) => resources.map((of) => of.get(`${group}.${binding}`)).filter(Boolean);
  for (const one of reflection.uniforms) {
    for (const { layout } of having(one.group, one.binding)) {
      // What a shader does not read may be left out of its text.
      const member = one.block ? one.name.replace(new RegExp(`^${one.block}\\.`), "") : one.name;
      const place = layout && placeOf(member, layout);
      if (!place) continue;
      count += 1;
      if (place.offset !== one.offset) complaints.push(`${one.name} is at ${place.offset}, not at ${one.offset}`);
      if (one.array_stride && place.layout.stride !== one.array_stride) complaints.push(`${one.name} has a stride of ${place.layout.stride}, not of ${one.array_stride}`);
    }
  }
  for (const one of reflection.samplers) {
    const pair = [[one.texture, one.wgsl?.texture], [one.sampler, one.wgsl?.sampler]];
    for (const [at, told] of pair.filter(([at]) => at)) {
      for (const { name, type } of having(at.group, at.binding)) {
        count += 1;
        if (told && (name !== told.name || type !== told.type)) complaints.push(`${told.name}: ${told.type} is ${name}: ${type} in the text`);
      }
    }
  }
  const known = new Set([reflection.loose_block, ...reflection.blocks, ...reflection.samplers.flatMap((one) => [one.texture, one.sampler])].filter(Boolean).map(({ group, binding }) => `${group}.${binding}`));
  for (const key of resources.flatMap((of) => [...of.keys()])) if (!known.has(key)) complaints.push(`the text has a resource at ${key}, and the reflection has none`);
  return { complaints, count };
}
