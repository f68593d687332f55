
// ---- Plot: points, fronts and intervals on the chosen axes, in one chart or in a panel for each model.
const axes = { x: "work", y: "rmse" };
const hidden = new Set(); // Names of models and kinds that the legend has switched off.
// "each": a panel for each model; "together": one chart; or the number of a model.
let arranged = report.truths.length > 4 ? "each" : "together";
const plotted = { points: [] };

const isOn = (way) => (arranged !== "together" || !hidden.has("model:" + way.model)) && (typeof arranged !== "number" || way.model === arranged) && !hidden.has("kind:" + way.kindName);
const shortName = (way) => {
  const several = way.tessellation && ways.some((other) => other !== way && other.name === way.name && other.model === way.model);
  if (several) return `${way.number + 1} · ${way.tessellation.join("×")}`;
  const own = typeof arranged === "number" ? withoutModel(way.name, way.model_name) : way.name;
  const name = own.length > 44 ? own.slice(0, 43) + "…" : own;
  return `${way.number + 1} · ${name}`;
};

const chartFrame = (width) => ({
  width, labels: shortName, size: 12, apart: [54, 26], names: true,
  scale: 1, height: Math.round(Math.max(330, Math.min(600, width * 0.62))),
  left: width < 480 ? 52 : 62, right: 14, top: 26, bottom: 48,
});
// A panel has the numbers of its variants alone; its title is above it, the names of the axes are above all.
const panelFrame = (width) => ({
  width, labels: (way) => String(way.number + 1), size: 11, apart: [58, 34], names: false,
  scale: 0.8, height: Math.round(Math.max(180, width * 0.8)), left: 46, right: 10, top: 8, bottom: 24,
});

const drawPlot = () => {
  const place = byId("plot");
  const width = Math.max(260, Math.floor(place.clientWidth));
  const [across, up] = [ACROSS[axes.x], UP[axes.y]];
  const on = ways.filter(isOn).filter((way) => across.of(way) > 0 && Number.isFinite(up.of(way) ?? NaN));
  const isEach = arranged === "each";
  const columns = isEach ? Math.max(width > 290 ? 2 : 1, Math.min(4, Math.floor((width + 20) / 250))) : 1;
  const frame = isEach ? panelFrame(Math.floor((width - 20 * (columns - 1)) / columns)) : chartFrame(width);
  const scales = scalesOf(on, frame, across, up);
  const states = front(axes.x, axes.y);
  const panel = (members, name) => drawPanel({ members, name, frame, scales, states, across, up });
  plotted.points = [];
  if (isEach) {
    const panels = report.truths.map((truth, index) => html("figure", { class: `model-${index % COLORS}` },
      html("figcaption", {}, html("button", { type: "button", class: "enlarge", "aria-label": `Enlarge ${truth.model}`, click: () => arrange(index) }, html("i", { class: "swatch" }), truth.model)),
      panel(on.filter((way) => way.model === index), truth.model)));
    place.replaceChildren(
      html("p", { class: "of-axes" }, html("span", {}, `${up.name} ↑ worse`), html("span", {}, `${across.name} → ${across.better}`)),
      html("div", { class: "panels", style: `--panels:${columns}` }, panels));
  } else {
    place.replaceChildren(
      ...(typeof arranged === "number" && report.truths.length > 1
        ? [html("p", { class: "controls" }, html("strong", {}, report.truths[arranged].model), html("button", { type: "button", click: () => arrange("each") }, "All models"))] : []),
      panel(on, null));
  }
  note(on, across, up);
  showChoice();
};

// All panels have the same axes: those of all variants that are on.
const scalesOf = (on, frame, across, up) => {
  const errors = on.map(up.of);
  const hasZero = errors.includes(0);
  const foot = frame.height - frame.bottom;
  const x = logarithmic(
    on.flatMap((way) => (axes.x === "time" ? [across.of(way), ...way.ratio.interval] : [across.of(way)])).concat(axes.x === "time" ? 1 : []),
    frame.left, frame.width - frame.right, 0.03);
  const y = logarithmic(errors, foot - (hasZero ? 30 : 0), frame.top + (frame.names ? 0 : 8), 0.12);
  return { x, y, hasZero, foot };
};

const drawPanel = ({ members, name, frame, scales, states, across, up }) => {
  const { x, y, foot } = scales;
  const points = members.map((way) => ({
    way, state: states[way.number],
    x: x.place(across.of(way)), y: up.of(way) === 0 ? foot - 9 : y.place(up.of(way)),
    ends: axes.x === "time" ? way.ratio.interval.map((end) => (end > 0 ? x.place(end) : null)) : null,
  }));
  const drawing = svg("svg", {
    viewBox: `0 0 ${frame.width} ${frame.height}`, width: frame.width, height: frame.height, role: "group",
    "aria-label": `${name ? name + ": " : ""}${up.name} over ${across.name}: ${members.length} variants. Arrow keys go from point to point, Enter pins one, Escape frees it.`,
  });
  const panel = { drawing, frame, points, lines: [], foot };
  for (const point of points) point.panel = panel;
  drawGrid(panel, scales, across, up);
  drawFronts(panel);
  drawPoints(panel);
  plotted.points.push(...points);
  drawing.addEventListener("pointermove", (event) => hover(nearest(event, panel)?.way.number ?? null));
  drawing.addEventListener("pointerleave", () => hover(null));
  drawing.addEventListener("click", (event) => {
    const point = nearest(event, panel);
    if (point) pinAt(point);
  });
  drawing.addEventListener("keydown", travel);
  return drawing;
};

const drawGrid = ({ drawing, frame, foot }, { x, y, hasZero }, across, up) => {
  const right = frame.width - frame.right;
  for (const tick of x.ticks(frame.apart[0])) {
    const at = x.place(tick).toFixed(1);
    drawing.append(svg("path", { class: "grid", d: `M${at} ${frame.top}V${foot}` }), svg("text", { class: "tick", x: at, y: foot + 16, "text-anchor": "middle" }, across.tick(tick)));
  }
  for (const tick of y.ticks(frame.apart[1])) {
    const at = y.place(tick);
    drawing.append(svg("path", { class: "grid", d: `M${frame.left} ${at.toFixed(1)}H${right}` }), svg("text", { class: "tick", x: frame.left - 6, y: at + 4, "text-anchor": "end" }, asPower(tick)));
  }
  if (hasZero) {
    drawing.append(svg("path", { class: "grid broken", d: `M${frame.left} ${foot - 22}H${right}` }), svg("text", { class: "tick", x: frame.left - 6, y: foot - 5, "text-anchor": "end" }, "0"));
  }
  if (axes.x === "time") {
    const [low, high] = report.timing.same_again.interval;
    if (low > 0 && high > 0) {
      const [from, to] = [low, high].map((end) => Math.max(frame.left, Math.min(right, x.place(end))));
      drawing.append(svg("rect", { class: "noise", x: from, y: frame.top, width: to - from, height: foot - frame.top }));
    }
    const one = x.place(1);
    drawing.append(svg("path", { class: "one", d: `M${one.toFixed(1)} ${frame.top}V${foot}` }));
  }
  drawing.append(svg("path", { class: "border", d: `M${frame.left} ${frame.top}V${foot}H${right}` }));
  if (!frame.names) return;
  drawing.append(
    svg("text", { class: "axis", x: right, y: frame.height - 8, "text-anchor": "end" }, `${across.name} → ${across.better}`),
    svg("text", { class: "axis", x: 4, y: 13 }, `${up.name} ↑ worse`));
};

const pathOf = (places) => "M" + places.map((place) => place.map((one) => one.toFixed(1)).join(" ")).join("L");

// A front is a staircase: what is above and to the right of it is beaten.
const drawFronts = (panel) => {
  const { drawing, frame, points } = panel;
  const joined = (places) => places.slice(1).forEach(([x, y], index) => panel.lines.push([...places[index], x, y]));
  panel.lines = points.filter((point) => point.ends?.[0] && point.ends[1]).map((point) => [point.ends[0], point.y, point.ends[1], point.y]);
  for (const model of new Set(points.map((point) => point.way.model))) {
    const members = points.filter((point) => point.way.model === model);
    const best = members.filter((point) => point.state === "yes").sort((a, b) => a.x - b.x || b.y - a.y);
    if (best.length) {
      const steps = best.flatMap((point, index) => [[point.x, index ? best[index - 1].y : frame.top], [point.x, point.y]]);
      steps.push([frame.width - frame.right, best.at(-1).y]);
      joined(steps);
      drawing.append(svg("path", { class: `front ${best[0].way.color}`, d: pathOf(steps) }));
    }
    for (const name of new Set(members.map((point) => point.way.name))) {
      const series = members.filter((point) => point.way.name === name).sort((a, b) => a.way.vertices - b.way.vertices);
      if (series.length < 2) continue;
      const places = series.map((point) => [point.x, point.y]);
      joined(places);
      drawing.append(svg("path", { class: `series ${series[0].way.color}`, d: pathOf(places) }));
    }
  }
};

const drawPoints = ({ drawing, frame, points, lines, foot }) => {
  const rank = { yes: 0, open: 1, no: 2 };
  const order = [...points].sort((a, b) => rank[a.state] - rank[b.state] || a.x - b.x);
  const fontOf = (point) => `${point.state === "yes" ? "600 " : ""}${frame.size}px system-ui, "Segoe UI", Arial, sans-serif`;
  // Points at one place have one label.
  for (const point of order) point.label = null;
  for (const point of order) {
    point.together = points.filter((other) => Math.hypot(other.x - point.x, other.y - point.y) < 4);
    if (point.together.some((other) => other !== point && other.label)) continue;
    point.label = frame.labels(point.way) + (point.together.length > 1 ? ` +${point.together.length - 1}` : "");
  }
  const boxes = placeLabels(order, { width: frame.width - 2, height: foot - 2, left: frame.left + 3, top: frame.top, font: fontOf, lines });
  for (const { way, y, ends } of order) {
    if (!ends || ends[0] === null || ends[1] === null) continue;
    const [from, to] = ends.map((end) => end.toFixed(1));
    const [at, above] = [y.toFixed(1), (y - 4).toFixed(1)];
    drawing.append(svg("path", { class: `spread ${way.color}`, d: `M${from} ${at}H${to}M${from} ${above}v8M${to} ${above}v8` }));
  }
  order.forEach((point, index) => {
    const box = boxes[index];
    if (!box) return;
    if (box.far) {
      const [cx, cy] = [Math.max(box.x, Math.min(point.x, box.x + box.w)), box.y + box.h / 2];
      drawing.append(svg("path", { class: "leader", d: `M${point.x.toFixed(1)} ${point.y.toFixed(1)}L${cx.toFixed(1)} ${cy.toFixed(1)}` }));
    }
    drawing.append(svg("rect", { class: "under", x: box.x.toFixed(1), y: box.y.toFixed(1), width: box.w.toFixed(1), height: box.h, rx: 3 }));
    drawing.append(svg("text", { class: `label ${point.state}`, style: `font-size:${frame.size}px`, x: (box.x + 3).toFixed(1), y: (box.y + 12).toFixed(1) }, point.label));
  });
  // The front is drawn last, so that it is on top.
  for (const point of [...order].reverse()) {
    const { way, state, x, y } = point;
    point.node = svg("g", { class: `point ${way.color} ${state}`, tabindex: "-1", role: "button", "aria-pressed": "false", "aria-label": spoken(point), focus: () => hover(way.number), blur: () => hover(null) },
      svg("g", { transform: `translate(${x.toFixed(1)} ${y.toFixed(1)}) scale(${frame.scale})` },
        svg("circle", { class: "halo", r: "12" }),
        state === "no" ? null : svg("circle", { class: "ring", r: "10.5" }),
        svg("path", { class: `mark ${state}`, d: markOf(way.shape), transform: state === "no" ? "scale(.78)" : null })));
    drawing.append(point.node);
  }
  roving(order[0], points);
};

// One point of a panel is in the order of Tab; the arrows reach the others.
const roving = (point, points) => {
  for (const other of points) other.node.setAttribute("tabindex", other === point ? "0" : "-1");
};

const spoken = ({ way, state }) => {
  const [across, up] = [ACROSS[axes.x], UP[axes.y]];
  const place = { yes: "on the front", open: "open whether on the front", no: "not on the front" }[state];
  const ends = axes.x === "time" && way.ratio.interval[0] !== null ? `, 95 % from ${way.ratio.interval.map((end) => end.toFixed(2)).join(" to ")}` : "";
  return `${way.number + 1}, ${way.title}, ${way.kind}: ${up.name} ${scientific(up.of(way))}, ${across.name} ${axes.x === "time" ? across.of(way).toFixed(2) : across.of(way)}${ends}; ${place}`;
};

const nearest = (event, { drawing, points }) => {
  const box = drawing.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left, event.clientY - box.top];
  let best = null;
  for (const point of points) {
    const far = Math.hypot(point.x - x, point.y - y);
    if (far < (best?.far ?? 26)) best = { point, far };
  }
  return best?.point;
};

// A second click at points of one place goes on to the next of them.
const pinAt = (point) => {
  const together = point.together;
  const at = together.findIndex((other) => other.way.number === choice.pinned);
  const next = together[(at + 1) % together.length];
  pin(choice.pinned === next.way.number ? null : next.way.number);
};

const STEPS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const travel = (event) => {
  const here = plotted.points.find((point) => point.node === document.activeElement);
  if (!here) return;
  const way = here.way.number;
  if (event.key === "Enter" || event.key === " ") pin(choice.pinned === way ? null : way);
  else if (event.key === "Escape") pin(null);
  else if (STEPS[event.key] || event.key === "Home" || event.key === "End") {
    const key = STEPS[event.key]?.[0] === 0 ? "y" : "x";
    const order = [...here.panel.points].sort((a, b) => a[key] - b[key] || a.way.number - b.way.number);
    const step = STEPS[event.key] ? STEPS[event.key][0] + STEPS[event.key][1] : event.key === "Home" ? -order.length : order.length;
    const next = order[Math.max(0, Math.min(order.length - 1, order.indexOf(here) + step))];
    roving(next, here.panel.points);
    next.node.focus();
  } else return;
  event.preventDefault();
};

const showChoice = () => {
  for (const { node, way } of plotted.points) {
    node.classList.toggle("on", way.number === shown());
    node.classList.toggle("pinned", way.number === choice.pinned);
    node.setAttribute("aria-pressed", String(way.number === choice.pinned));
  }
  const point = plotted.points.find(({ way }) => way.number === shown());
  plotted.guide?.remove();
  if (!point || choice.hover === null) return;
  const { frame, drawing } = point.panel;
  plotted.guide = svg("path", { class: "guide", d: `M${frame.left} ${point.y.toFixed(1)}H${point.x.toFixed(1)}V${frame.height - frame.bottom}` });
  drawing.append(plotted.guide);
};

const note = (on, across, up) => {
  const off = ways.filter((way) => isOn(way)).length - on.length;
  const rule = axes.x === "work"
    ? "A front is the staircase through the variants that no other variant of the model beats in work and in this error."
    : "Bars are 95 % intervals. Hollow: it is open whether the variant is on the front. The gray strip around 1 is the baseline timed twice: differences of that size mean nothing.";
  const panels = arranged === "each" ? " Numbers are those of the table. A panel\u2019s title enlarges it." : "";
  byId("plot-note").textContent = `Down and to the left is better. ${rule}${panels}${off ? ` ${off} variants have no ${across.name} or ${up.name}.` : ""}`;
};

const drawLegend = () => {
  const place = byId("legend");
  const toggle = (key, content) => html("button", {
    type: "button", class: "toggle", "aria-pressed": String(!hidden.has(key)),
    click: (event) => {
      hidden.has(key) ? hidden.delete(key) : hidden.add(key);
      event.currentTarget.setAttribute("aria-pressed", String(!hidden.has(key)));
      drawPlot();
    },
  }, content);
  const row = (name, ...items) => html("div", { role: "group", "aria-label": name }, html("span", { class: "term" }, name), items);
  const models = report.truths.map((truth, index) => toggle("model:" + index, [html("i", { class: `swatch model-${index % COLORS}` }), truth.model]));
  const marks = kinds.map((kind, shape) => toggle("kind:" + kind, [marker({ shape, color: "neutral" }), kind]));
  const key = (state, text) => html("span", { class: "state" }, svg("svg", { viewBox: "-12 -12 24 24", width: 20, height: 20, class: "key neutral", "aria-hidden": "true" },
    state === "no" ? null : svg("circle", { class: "ring", r: "10.5" }), svg("path", { class: `mark ${state}`, d: SHAPES[0], transform: state === "no" ? "scale(.78)" : null })), text);
  place.replaceChildren(
    ...(models.length > 1 && arranged === "together" ? [row("Model", ...models)] : []),
    row("Kind", ...marks),
    row("Front", key("yes", "on it"), key("open", "open"), key("no", "not on it")));
  place.hidden = false;
};

const arrange = (to) => {
  arranged = to;
  byId("plot-models").value = String(to);
  drawLegend();
  drawPlot();
};
byId("plot-models").append(
  html("option", { value: "each" }, "A panel for each"), html("option", { value: "together" }, "All in one chart"),
  html("optgroup", { label: "One model" }, report.truths.map((truth, index) => html("option", { value: index }, truth.model))));
byId("plot-models").value = arranged;
byId("plot-models").closest("label").hidden = report.truths.length < 2;
byId("plot-models").addEventListener("change", (event) => arrange(/^\d/.test(event.target.value) ? Number(event.target.value) : event.target.value));
for (const input of all("#axes input")) {
  input.addEventListener("change", () => {
    axes[input.name] = input.value;
    drawPlot();
  });
}
if (!ways.some((way) => way.ratio.median > 0)) byId("axes").querySelector("[value=time]").disabled = true;
byId("axes").hidden = false;
choice.listeners.push(showChoice);
drawLegend();
drawPlot();
let drawnWidth = byId("plot").clientWidth;
new ResizeObserver(() => {
  if (byId("plot").clientWidth === drawnWidth) return;
  drawnWidth = byId("plot").clientWidth;
  drawPlot();
}).observe(byId("plot"));
