
// ---- Studies of a scene: what its picture does not need, what f32 does to it, what other ways to shade it cost. Each takes a while, so a
// person asks for it; what was found for older texts is told as such.
// `changed` is called when other lines are to be crossed out.
const makeStudies = ({ ask, open, inspect, edition, isOwn, kept, changed }) => {
  const NAMES = ["needs", "stability", "variants"];
  const found = new Map(NAMES.map((name) => [name, null]));  // the answer, and the edition of the texts that it is for
  let chosen = null, running = null;
  const button = (name) => byId(`study-${name}`);
  const base = (name) => name.split(/[\\/]/).at(-1);
  const note = (text) => { byId("study-note").textContent = text; };
  const short = (value) => {
    if (value === null || !Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    return Math.abs(value) >= 1e-3 && Math.abs(value) < 1e6 ? String(Number(value.toPrecision(3))) : value.toExponential(1);
  };
  const place = (file, line, column) => html("button", { class: "link", click: () => open(file, line, column) }, `${base(file)}:${line}`);
  const table = (heads, rows) => html("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "Table" }, html("table", {},
    html("thead", {}, html("tr", {}, heads.map((head) => html("th", {}, head)))), html("tbody", {}, rows)));
  const row = (cells) => html("tr", {}, cells.map((cell) => html("td", {}, cell)));

  // What the picture does not need.
  const FIGURES = [
    ["spirv_instructions", "instructions of the program"], ["fragment_operations", "operations for each fragment, summed"],
    ["vertex_operations", "operations for each vertex, summed"], ["varyings", "values that are interpolated"], ["attributes", "vertex attributes"],
    ["attribute_bytes", "bytes of vertices"], ["uniform_bytes", "bytes of uniforms"], ["textures", "textures"],
  ];
  const showNeeds = (account) => {
    const parts = account.draws.flatMap((draw, index) => {
      const rows = FIGURES.filter(([key]) => draw.before[key] || draw.after[key]).map(([key, name]) => {
        const [before, after] = [draw.before[key], draw.after[key]];
        const share = before ? `${Math.round((100 * after) / before)} %` : "–";
        return row([name, String(before), String(after), after === before ? "" : share]);
      });
      // The same part may go from both stages.
      const parts = new Map(draw.left_out.map((one) => [JSON.stringify(one), one]));
      const files = new Map();
      for (const one of parts.values()) files.set(one.file, [...(files.get(one.file) ?? []), one]);
      const item = (one) => html("li", {}, place(one.file, one.line), ` ${one.what} `, html("code", {}, one.name), html("div", { class: "help" }, one.because));
      const list = ([file, list]) => html("details", { open: isOwn(file) ? "" : null }, html("summary", {}, `${base(file)}: ${list.length}`), html("ul", { class: "found" }, [...list].sort((a, b) => a.line - b.line).map(item)));
      const lists = [...files].sort(([a], [b]) => isOwn(b) - isOwn(a)).map(list);
      const title = account.draws.length > 1 ? [html("h3", {}, `Draw ${index + 1}`)] : [];
      return [...title, table(["figure", "as written", "needed", "of it"], rows), ...lists];
    });
    const n = account.draws.reduce((sum, draw) => sum + new Set(draw.left_out.map((one) => JSON.stringify(one))).size, 0);
    note(n ? `This picture does without ${n} ${n === 1 ? "part" : "parts"} of the program, with these uniforms, textures and attributes. Their lines are crossed out. “Only what this picture needs” below shows what is left.` : "This picture needs the whole program.");
    return parts;
  };

  // What f32 does to the picture.
  const VERDICTS = { stable: "good", degraded: "fair", broken: "bad" };
  const showStability = (told) => {
    const { picture, causes } = told;
    const spot = ({ x, y }) => (isLive ? html("button", { class: "link", click: () => inspect(x, y) }, `pixel ${x}, ${y}`) : `pixel ${x}, ${y}`);
    const worst = picture.worst ? [html("p", {}, `f32 differs from exact arithmetic by at most ${short(picture.max_abs)} in a channel, at `, spot(picture.worst), `. ${short(told.bound)} is accepted.`)] : [html("p", {}, "f32 draws what exact arithmetic draws.")];
    const map = html("img", { src: told.map, width: told.width, height: told.height, alt: "the errors over the picture", draggable: "false" });
    if (isLive) map.addEventListener("click", (event) => inspect(...pixelAt(map, event, told.width, told.height)));
    const item = (cause) => html("li", {}, place(cause.file, cause.line, cause.column), ` ${cause.kind}, harm ${short(cause.harm)}, ${short(cause.lost_bits)} bits lost, worst at `, spot(cause.where), html("div", { class: "help" }, cause.help));
    byId("study-verdict").hidden = false;
    byId("study-verdict").className = `pill ${VERDICTS[told.verdict] ?? ""}`;
    byId("study-verdict").textContent = told.verdict;
    note(causes.length ? "These expressions do the harm, the worst first." : "No expression does harm above the bound, with these inputs. `glisten stability --stiff` searches for inputs that do.");
    return [...worst, html("figure", { class: "map" }, map, html("figcaption", {}, "error: blue is a hundredth of what is accepted, yellow that, red a hundred times as much, magenta not finite")), html("ul", { class: "found" }, causes.map(item))];
  };

  // The error of variants against their cost, both by their logarithms.
  const WIDTH = 460, HEIGHT = 250, LEFT = 62, BOTTOM = 34, TOP = 12, RIGHT = 16;
  const svg = element("http://www.w3.org/2000/svg");
  // What a variant costs: the time is measured, the work of the reference is exact.
  const COSTS = {
    time: { name: "time, as a multiple of the first", of: (way) => way.ratio.median, isOn: (way) => way.pareto_time !== "no", isSure: (way) => way.pareto_time === "yes" },
    work: { name: "work, as a multiple of the first", of: (way, first) => way.work.operations / Math.max(1, first.work.operations), isOn: (way) => way.pareto, isSure: (way) => way.pareto },
  };
  const RATIOS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
  const FINE = [0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.3, 1.5];
  const span = (values, least) => {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const more = Math.max(0.08 * (high - low), (least - (high - low)) / 2);
    return [low - more, high + more];
  };
  const plot = (ways, cost, now, enter) => {
    const positive = ways.map((way) => way.error.rmse).filter((error) => error > 0);
    // No error at all is a step below the least one.
    const none = Math.min(...positive, 1e-3) / 10;
    const errorOf = (way) => Math.log10(Math.max(way.error.rmse, none));
    const costOf = (way) => Math.log10(Math.max(cost.of(way, ways[0]), 1e-6));
    const [left, right] = span(ways.map(costOf), 0.3), [bottom, top] = span(ways.map(errorOf), 1.0);
    const x = (at) => LEFT + ((at - left) / (right - left)) * (WIDTH - LEFT - RIGHT);
    const y = (at) => HEIGHT - BOTTOM - ((at - bottom) / (top - bottom)) * (HEIGHT - BOTTOM - TOP);
    const across = (right - left > 0.8 ? RATIOS : FINE).filter((ratio) => Math.log10(ratio) >= left && Math.log10(ratio) <= right);
    const up = Array.from({ length: Math.floor(top) - Math.ceil(bottom) + 1 }, (_, index) => Math.ceil(bottom) + index);
    const shownUp = up.filter((_, index) => index % Math.ceil(up.length / 8) === 0);
    const decade = (power) => (power >= -2 && power <= 2 ? String(Number((10 ** power).toFixed(2))) : `1e${power}`);
    const grid = [
      ...across.flatMap((ratio) => [svg("line", { x1: x(Math.log10(ratio)), x2: x(Math.log10(ratio)), y1: TOP, y2: HEIGHT - BOTTOM, class: "grid" }), svg("text", { x: x(Math.log10(ratio)), y: HEIGHT - BOTTOM + 14, "text-anchor": "middle" }, String(ratio))]),
      ...shownUp.flatMap((power) => [svg("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(power), y2: y(power), class: "grid" }), svg("text", { x: LEFT - 6, y: y(power) + 4, "text-anchor": "end" }, decade(power))]),
    ];
    // The steps of the front: from the cheapest on, each variant with less error than all before.
    const front = ways.filter(cost.isOn).sort((a, b) => costOf(a) - costOf(b) || errorOf(a) - errorOf(b));
    const steps = front.filter((way, index) => front.slice(0, index).every((other) => errorOf(other) > errorOf(way)));
    const path = steps.map((way, index) => `${index ? `H${x(costOf(way)).toFixed(1)}V` : `M${x(costOf(way)).toFixed(1)},`}${y(errorOf(way)).toFixed(1)}`).join("");
    const dots = ways.map((way, index) => {
      const [cx, cy] = [x(costOf(way)), y(errorOf(way))];
      const isNamed = steps.includes(way) || index === now;
      return svg("g", { class: `dot${cost.isSure(way) ? " is-on" : cost.isOn(way) ? " is-open" : ""}${index === now ? " is-now" : ""}`, pointerenter: () => enter(index) },
        svg("circle", { cx, cy, r: 5 }), isNamed ? svg("text", { x: cx + 8, y: cy - 6 }, String(index + 1)) : null, svg("title", {}, way.title));
    });
    const middle = (HEIGHT - BOTTOM) / 2;
    const words = [svg("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, cost.name), svg("text", { x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` }, "error (RMSE)")];
    return svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "error against cost; the table has the numbers", class: "plot" }, grid, svg("path", { class: "front", d: path }), dots, words);
  };
  const FRONT = { yes: "yes", no: "", open: "open" };
  let by = "time";
  const showVariants = (report) => {
    const ways = report.ways.filter((way) => Number.isFinite(way.ratio?.median) && way.ratio.median > 0);
    const image = html("img", { alt: "the picture of the variant", width: report.size[0], height: report.size[1], draggable: "false" });
    const name = html("figcaption", {});
    const chart = html("div", {});
    const cells = (way, index) => [String(index + 1), way.title, short(way.error.rmse), short(way.error.max_abs), short(way.ratio.median), `${short(way.ratio.interval[0])} … ${short(way.ratio.interval[1])}`, FRONT[way.pareto_time] ?? "", String(way.work.operations), way.pareto ? "yes" : ""];
    let now = 0;
    const draw = () => chart.replaceChildren(plot(ways, COSTS[by], now, enter));
    const rows = ways.map((way, index) => html("tr", { tabindex: "0", pointerenter: () => enter(index), focus: () => enter(index) }, cells(way, index).map((cell) => html("td", {}, cell))));
    const enter = (index) => {
      rows[now].classList.remove("is-chosen");
      rows[index].classList.add("is-chosen");
      const isOther = index !== now;
      now = index;
      image.src = ways[index].picture;
      name.textContent = `${index + 1}: ${ways[index].title}${ways[index].about ? `. ${ways[index].about}` : ""}`;
      if (isOther) draw();
    };
    const choice = ([key]) => html("label", {}, html("input", { type: "radio", name: "study-cost", value: key, checked: key === by, change: () => { by = key; draw(); } }), key);
    if (ways.length) { enter(0); draw(); }
    const noise = Math.abs(report.timing.same_again.median - 1);
    note(`${ways.length} ways to draw this scene on ${report.adapter.name}, each against the reference in f64 of its model. A copy of the first differs by ${short(100 * noise)} % in time. What the measured times do not decide is open; the work, which the reference counts, is exact. \`glisten report --ways auto\` times longer and writes the programs.`);
    const skipped = report.skipped.length ? [html("p", { class: "note" }, `Not drawn: ${report.skipped.map((one) => `${one.name} (${one.because})`).join("; ")}`)] : [];
    return [html("fieldset", {}, html("legend", {}, "Cost"), Object.entries(COSTS).map(choice)), html("div", { class: "front-and-picture" }, chart, html("figure", {}, image, name)),
      table(["number", "variant", "RMSE", "largest", "time", "95 %", "front", "work", "front"], rows), ...skipped];
  };

  const SHOW = { needs: showNeeds, stability: showStability, variants: showVariants };
  const WAITS = { needs: "evaluating the programs …", stability: "drawing in f32 and exactly …", variants: "drawing the variants, then timing them for some seconds …" };
  const show = () => {
    NAMES.forEach((name) => button(name).setAttribute("aria-pressed", String(name === chosen)));
    byId("study-verdict").hidden = true;
    const one = chosen && found.get(chosen);
    if (!one) { byId("study").replaceChildren(); return; }
    byId("study").replaceChildren(...(one.error ? [] : SHOW[chosen](one.ok)));
    if (one.error) note(`Not found: ${one.error}`);
    const isOld = one.edition !== edition();
    byId("study").classList.toggle("is-old", isOld);
    if (isOld) note("This is of the texts before the last change; press the button again.");
  };
  const run = async (name) => {
    chosen = name;
    const asked = edition();
    running = name;
    byId("study").replaceChildren();
    byId("study-verdict").hidden = true;
    NAMES.forEach((one) => button(one).setAttribute("aria-pressed", String(one === name)));
    note(WAITS[name]);
    // An exported page has the answers, or the reasons why there are none.
    const told = kept?.[name];
    const answer = told ? { ok: told, error: told.error } : await ask({ ask: name });
    if (running === name) running = null;
    if (answer.status === 409) return;
    found.set(name, { ok: answer.ok, error: answer.error, edition: asked });
    if (chosen === name) { show(); changed(); }
  };
  NAMES.forEach((name) => button(name).addEventListener("click", () => { run(name).catch((error) => note(`no answer: ${error.message}`)); }));
  return {
    // The texts changed.
    age: () => { if (!running) show(); changed(); },
    // Another scene.
    forget: () => {
      NAMES.forEach((name) => found.set(name, null));
      chosen = null;
      show();
      note("What could this picture do without, what does f32 do to it, and what would another way to shade it cost?");
    },
    // The lines of a file that the picture does without, with the reason.
    linesOf: (file) => {
      const one = chosen === "needs" ? found.get("needs") : null;
      if (!one?.ok || one.edition !== edition()) return [];
      return one.ok.draws.flatMap((draw) => draw.left_out).filter((entry) => entry.file === file).map(({ line, what, name, because }) => ({ line, title: `${what} ${name}: ${because}` }));
    },
  };
};
