
// ---- Profile: the luminance along the row through the highlight, picture against reference.
const profiled = { at: null };
const line = (values, x, y) => {
  let path = "";
  let open = false;
  values.forEach((value, index) => {
    if (value === null) open = false;
    else {
      path += `${open ? "L" : "M"}${x(index).toFixed(1)} ${y(value).toFixed(1)}`;
      open = true;
    }
  });
  return path;
};
const bends = (values) => values.map((value, index) => {
  const [before, after] = [values[index - 1] ?? null, values[index + 1] ?? null];
  return value === null || before === null || after === null ? null : before - 2 * value + after;
});
const linear = (values, from, to, atLeast) => {
  let [low, high] = [Math.min(...values, atLeast[0]), Math.max(...values, atLeast[1])];
  if (low === high) high = low + 1e-9;
  const step = 10 ** Math.floor(Math.log10((high - low) / 2));
  const fine = [5, 2, 1].map((factor) => factor * step).find((one) => (high - low) / one >= 2) ?? step;
  const ticks = [];
  for (let tick = Math.ceil(low / fine); tick * fine <= high * 1.0001; tick += 1) ticks.push(tick * fine);
  return { place: (value) => from + ((value - low) / (high - low)) * (to - from), ticks };
};

const showProfile = () => {
  const way = ways[choice.stage];
  const truth = way && model(way);
  const place = byId("profile");
  const count = truth?.profile.length ?? 0;
  place.parentElement.hidden = !truth || !truth.profile.some((value) => value !== null);
  if (place.parentElement.hidden) return;
  const width = Math.max(280, Math.floor(place.clientWidth));
  const [left, right] = [72, width - 10];
  const isBands = stage.view === "bands";
  const known = truth.profile.flatMap((value, index) => (value === null && (way.profile[index] ?? null) === null ? [] : [index]));
  const [first, last] = [Math.max(0, known[0] - 2), Math.min(count - 1, known.at(-1) + 2)];
  const x = (index) => left + ((index - first) / Math.max(1, last - first)) * (right - left);
  const finite = (values) => values.filter((value) => value !== null);
  const drawing = svg("svg", { viewBox: `0 0 ${width} 360`, width, height: 360, role: "group", tabindex: "0", "aria-label": `Luminance along row ${truth.row}. Left and right arrows read it.` });
  const lower = isBands
    ? [[bends(truth.profile), "truth"], [bends(way.profile), "ours"]]
    : [[way.profile.map((value, index) => (value === null || truth.profile[index] === null ? null : value - truth.profile[index])), "ours"]];
  const upper = [[truth.profile, "truth"], [way.profile, "ours"]];
  const parts = [[upper, 18, 196, "luminance", [0, 0]], [lower, 228, 324, isBands ? "second difference along the row" : "variant − reference", [-1e-7, 1e-7]]];
  for (const [lines, top, foot, name, atLeast] of parts) {
    // Not all of a silhouette: the scale of bends is that of the inside.
    const all = lines.flatMap(([values]) => finite(values));
    const sorted = [...all].sort((a, b) => a - b);
    const cut = isBands && foot > 300 ? Math.floor(sorted.length * 0.01) : 0;
    const y = linear(sorted.slice(cut, sorted.length - cut), foot, top, atLeast);
    const clamp = (value) => Math.max(top, Math.min(foot, y.place(value)));
    for (const tick of y.ticks) {
      const at = y.place(tick);
      drawing.append(svg("path", { class: "grid", d: `M${left} ${at.toFixed(1)}H${right}` }), svg("text", { class: "tick", x: left - 6, y: at + 4, "text-anchor": "end" }, foot > 300 ? (Math.abs(tick) < 1e-15 ? "0" : scientific(tick, 0).replace("-", "−")) : String(Number(tick.toPrecision(3)))));
    }
    drawing.append(svg("text", { class: "axis", x: left, y: top - 6 }, name));
    for (const [values, className] of lines) drawing.append(svg("path", { class: `line ${className} ${className === "ours" ? way.color : ""}`, d: line(values, x, clamp) }));
  }
  const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find((one) => x(first + one) - x(first) >= 48) ?? 2000;
  for (let index = Math.ceil(first / step) * step; index <= last; index += step) drawing.append(svg("text", { class: "tick", x: x(index), y: 342, "text-anchor": "middle" }, index));
  drawing.append(svg("text", { class: "axis", x: right, y: 357, "text-anchor": "end" }, "pixel →"));
  const cursor = svg("path", { class: "guide", d: "" });
  drawing.append(cursor);
  const read = (index) => {
    profiled.at = Math.max(first, Math.min(last, index));
    const [ours, theirs] = [way.profile[profiled.at], truth.profile[profiled.at]].map((value) => (value === null || value === undefined ? "–" : value.toFixed(6)));
    cursor.setAttribute("d", `M${x(profiled.at).toFixed(1)} 18V324`);
    byId("profile-note").lastChild.textContent = ` Pixel ${profiled.at}: variant ${ours}, reference ${theirs}.`;
  };
  drawing.addEventListener("pointermove", (event) => {
    const box = drawing.getBoundingClientRect();
    read(Math.round(first + ((event.clientX - box.left - left) / (right - left)) * (last - first)));
  });
  drawing.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 }[event.key];
    if (!by) return;
    event.preventDefault();
    read((profiled.at ?? Math.round((first + last) / 2)) + by);
  });
  place.replaceChildren(drawing);
  const sample = (className) => svg("svg", { viewBox: "0 0 30 10", width: 30, height: 10, class: "key", "aria-hidden": "true" }, svg("path", { class: `line ${className}`, d: "M0 5H30" }));
  byId("profile-note").replaceChildren(
    html("span", { class: "state" }, sample(`ours ${way.color}`), `${way.number + 1} ${way.title}`),
    html("span", { class: "state" }, sample("truth"), "the reference"),
    html("span", {}, `Row ${truth.row} of the picture, through its brightest pixel; the luminance of the framebuffer's values.`),
    html("span", {}, ""));
};
byId("stage").hidden = !ways.length;
choice.listeners.push(followChoice);
followChoice();
let profileWidth = byId("profile").clientWidth;
new ResizeObserver(() => {
  if (byId("profile").clientWidth === profileWidth) return;
  profileWidth = byId("profile").clientWidth;
  showProfile();
}).observe(byId("profile"));
