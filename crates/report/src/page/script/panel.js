
// ---- Panel: everything about the variant that is chosen.
const heads = all("#table thead th");
const cellsOf = (number) => new Map(all("th, td", byId("row-" + number)).map((cell, index) => [heads[index].dataset.column, cell.textContent]));
const GROUPS = [
  ["Error", ["rmse", "max_abs", "psnr", "flip", "max_ulp", "rounding", "edges", "non_finite"]],
  ["Work", ["operations", "lookups", "vertices", "fragments"]],
  ["Time", ["milliseconds", "ratio", "interval"]],
  ["Front", ["pareto", "pareto_time"]],
];
const headOf = new Map(heads.map((head) => [head.dataset.column, head]));
const headText = new Map(heads.map((head) => [head.dataset.column, head.textContent]));

const figures = (way) => {
  const cells = cellsOf(way.number);
  return GROUPS.map(([name, columns]) => html("div", { class: "group" }, html("h4", {}, name),
    html("dl", {}, columns.map((column) => html("div", { title: headOf.get(column).dataset.help },
      html("dt", {}, headText.get(column)), html("dd", {}, cells.get(column)))))));
};

const programs = (way) => {
  const count = way.programs.length;
  if (!count) return [];
  return [html("div", { class: "group" }, html("h4", {}, "Program"), way.programs.map(([name, text]) =>
    html("details", {}, html("summary", {}, `${name}, ${page.texts[text].split("\n").length - 1} lines`),
      html("pre", { tabindex: "0" }, html("code", {}, page.texts[text])))))];
};

const together = (way) => {
  const others = plotted.points.find((point) => point.way === way)?.together.filter((other) => other.way !== way) ?? [];
  if (!others.length) return [];
  return [html("p", { class: "note" }, "At the same place of the plot: ", others.flatMap((other, index) => [index ? ", " : "",
    html("button", { type: "button", class: "link", click: () => pin(other.way.number) }, `${other.way.number + 1} ${other.way.title}`)]))];
};

let told = null;
const showPanel = () => {
  const way = ways[shown()];
  const state = `${way?.number} ${choice.pinned} ${axes.x} ${axes.y}`;
  if (!way || state === told) return;
  told = state;
  const pinned = choice.pinned === way.number;
  byId("details").replaceChildren(
    html("p", { class: "kind" }, `${way.kind} · ${way.model_name}`),
    html("h3", {}, marker(way, way.pareto ? "yes" : "no", 22), html("span", { class: "number" }, way.number + 1), way.title),
    ...(way.about ? [html("p", { class: "about" }, way.about)] : []),
    html("p", { class: "acts" },
      html("button", { type: "button", "aria-pressed": String(pinned), click: () => pin(pinned ? null : way.number) }, pinned ? "Pinned" : "Pin"),
      html("a", { class: "button", href: "#stage", click: () => pin(way.number) }, "Compare the pictures")),
    ...together(way),
    html("div", { class: "groups" }, figures(way), programs(way)));
};
choice.listeners.push(showPanel);
byId("details").hidden = false;
drawPlot();
showPanel();
