
// ---- Data: the variants with what the page knows of them.
const { report, page } = JSON.parse(document.getElementById("data").textContent);

const SVG = document.querySelector("#plot svg").namespaceURI;
const svg = element(SVG);

const raised = (number) => String(number).replace(/[-0-9]/g, (sign) => (sign === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[sign]));
const decadeText = (exponent) => (exponent === 0 ? "1" : `10${raised(exponent)}`);
const scientific = (value, digits = 1) => {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return "–";
  const [factor, exponent] = value.toExponential(digits).split("e");
  return `${factor} × 10${raised(Number(exponent))}`;
};

const COLORS = 12;
// A kind of variant has one mark; variants that the scene declares differ by their names, without that of the model.
const withoutModel = (name, model) => {
  const rest = name.startsWith(model) ? /^[\s,:]+(.+)$/.exec(name.slice(model.length)) : null;
  return rest ? rest[1] : name;
};
const kindOf = (way) => (way.kind === "declared" ? withoutModel(way.name, way.model) : way.kind);
const kinds = [...new Set(report.ways.map(kindOf))];
const ways = report.ways.map((way, number) => ({
  ...way,
  ...page.ways[number],
  number,
  color: "model-" + (page.ways[number].model ?? 0) % COLORS,
  model_name: way.model,
  model: page.ways[number].model,
  kindName: kindOf(way),
  shape: kinds.indexOf(kindOf(way)),
}));

// Each picture is embedded once; where one is shown again, it is the same data.
const sources = [];
for (const image of all("img[data-picture]")) sources[image.dataset.picture] = image;
for (const place of all(".same")) {
  const known = sources[place.dataset.picture];
  if (!known) continue;
  const copy = known.cloneNode();
  copy.alt = place.dataset.alt;
  place.replaceWith(copy);
}

// ---- Choice: one variant is pinned, one may be under the pointer or the keyboard.
const choice = { pinned: null, hover: null, stage: 0, listeners: [] };
const shown = () => choice.hover ?? choice.pinned ?? choice.stage;
const changed = () => { for (const listener of choice.listeners) listener(); };
const hover = (number) => {
  if (choice.hover === number) return;
  choice.hover = number;
  changed();
};
const pin = (number) => {
  choice.pinned = number;
  if (number !== null) choice.stage = number;
  choice.hover = null;
  byId("told").textContent = number === null ? "No variant is pinned." : `Pinned: ${ways[number].title}.`;
  changed();
};
document.body.append(html("p", { id: "told", class: "hidden", role: "status" }));
// At first, the variant of the front with the largest error: there is something to see.
choice.stage = ways.filter((way) => way.pareto).sort((a, b) => b.error.rmse - a.error.rmse)[0]?.number ?? 0;

// On a telephone, the facts are folded: the chart comes first.
const factsList = document.querySelector(".facts");
factsList.classList.add("folded");
byId("all-facts").hidden = false;
byId("all-facts").addEventListener("click", () => {
  const folded = factsList.classList.toggle("folded");
  byId("all-facts").setAttribute("aria-expanded", String(!folded));
  byId("all-facts").textContent = folded ? "All facts" : "Fewer facts";
});
