
// ---- Texts: the editor knows one line ending, files have theirs; places of a text move when it changes.

// A text as the editor has it.
const plain = (raw) => raw.replace(/\r\n?/g, "\n");
// Turns places (UTF-16 code units) of a text as it is on disk into those of its plain form.
const plainPlaces = (raw) => {
  const dropped = [...raw.matchAll(/\r\n/g)].map((pair) => pair.index);
  if (!dropped.length) return (place) => place;
  return (place) => {
    let [low, high] = [0, dropped.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (dropped[middle] < place) low = middle + 1; else high = middle;
    }
    return place - low;
  };
};
// How many elements two lists or texts have in common, at their beginnings and at their ends.
const common = (a, b) => {
  const most = Math.min(a.length, b.length);
  let first = 0, last = 0;
  while (first < most && a[first] === b[first]) first += 1;
  while (last < most - first && a[a.length - 1 - last] === b[b.length - 1 - last]) last += 1;
  return { first, last };
};
const mostFrequent = (list) => {
  const counts = new Map();
  for (const one of list) counts.set(one, (counts.get(one) ?? 0) + 1);
  return [...counts].sort(([, a], [, b]) => b - a)[0]?.[0];
};
// A plain text with the line endings of `raw`: lines that begin and end both keep theirs, others get the one that most lines have.
const restored = (text, raw) => {
  if (!raw.includes("\r")) return text;
  const endings = raw.match(/\r\n?|\n/g);
  const usual = mostFrequent(endings);
  const [old, now] = [plain(raw).split("\n"), text.split("\n")];
  const { first, last } = common(old, now);
  const ending = (line) => {
    const same = line < first ? line : line >= now.length - last ? line - now.length + old.length : -1;
    return endings[same] ?? usual;
  };
  return now.map((line, index) => (index < now.length - 1 ? line + ending(index) : line)).join("");
};
// Moves places, each a beginning and an end, with a change of their text. One that the change touches becomes null.
const moving = (before, after) => {
  const { first, last } = common(before, after);
  const end = before.length - last, by = after.length - before.length;
  return (place) => {
    if (!place || (first === end && by === 0)) return place;
    if (place[1] < first) return place;
    return place[0] > end ? [place[0] + by, place[1] + by] : null;
  };
};

// ---- Numbers of a scene's text (TOML 1.0, Integer and Float).

// A number that a person typed, as TOML writes it; undefined if it is none.
const typedNumber = (text, kind) => {
  const [is, sign, whole, fraction = "", power = ""] = /^([+-]?)(\d*)(\.\d*)?([eE][+-]?\d+)?$/.exec(text.trim()) ?? [];
  if (is === undefined || !/\d/.test(whole + fraction)) return undefined;
  if (kind === "integer" && Number.isSafeInteger(Number(text))) return String(Number(text));
  const part = fraction.length > 1 ? fraction : fraction || (kind !== "integer" && !power) ? ".0" : "";
  return (sign === "-" ? "-" : "") + (whole.replace(/^0+(?=\d)/, "") || "0") + part + power;
};
// How many decimals tell the steps of a slider apart.
const decimalsOf = (step) => Math.max(0, Math.min(100, 1 - Math.floor(Math.log10(step))));
const rounded = (value, step) => (Number.isFinite(step) && step > 0 ? Number(value.toFixed(decimalsOf(step))) : value);
// A number as TOML writes it, no longer than it has to be.
const written = (value, kind) => {
  if (kind === "bool") return value ? "true" : "false";
  if (kind === "integer") return String(Math.round(value));
  const text = String(value);
  return /[.e]/.test(text) ? text : `${text}.0`;
};
