
// ---- Table: sorted by any column, and one with the plot.
const body = document.querySelector("#table tbody");
const rows = all("tr", body);
const written = new Map(rows.map((row, index) => [row, index]));
let sorted = { column: null, down: false };
const keyOf = (row, at) => {
  const { key } = row.children[at].dataset;
  const number = Number(key);
  return key === "" ? null : Number.isNaN(number) ? key : number;
};
const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
// Up, down, and as written. A figure that there is not is last either way.
const sortBy = (at) => {
  sorted = sorted.column !== at ? { column: at, down: false } : sorted.down ? { column: null, down: false } : { column: at, down: true };
  const order = [...rows].sort((a, b) => {
    if (sorted.column === null) return written.get(a) - written.get(b);
    const [left, right] = [keyOf(a, at), keyOf(b, at)];
    if (left === null || right === null) return (left === null) - (right === null) || written.get(a) - written.get(b);
    return (sorted.down ? -1 : 1) * compare(left, right) || written.get(a) - written.get(b);
  });
  body.append(...order);
  heads.forEach((head, index) => {
    const state = index !== sorted.column ? "none" : sorted.down ? "descending" : "ascending";
    head.setAttribute("aria-sort", state);
    head.querySelector(".arrow").textContent = { none: "", ascending: " ↑", descending: " ↓" }[state];
  });
};
const HELP = byId("table-help").textContent;
heads.forEach((head, index) => {
  const button = html("button", { type: "button", class: "sort", click: () => sortBy(index) }, head.textContent, html("span", { class: "arrow", "aria-hidden": "true" }));
  const help = () => { byId("table-help").textContent = `${headText.get(head.dataset.column)}: ${head.dataset.help}`; };
  const rest = () => { byId("table-help").textContent = HELP; };
  head.replaceChildren(button);
  button.setAttribute("aria-description", head.dataset.help);
  for (const [name, act] of [["focus", help], ["blur", rest], ["pointerenter", help], ["pointerleave", rest]]) button.addEventListener(name, act);
});
const showRows = () => {
  for (const row of rows) {
    const number = Number(row.dataset.way);
    row.classList.toggle("on", number === shown());
    row.classList.toggle("pinned", number === choice.pinned);
    row.setAttribute("aria-current", String(number === choice.pinned));
  }
  for (const card of all(".card[data-way]")) card.classList.toggle("pinned", Number(card.dataset.way) === choice.pinned);
};
for (const row of rows) {
  const number = Number(row.dataset.way);
  row.addEventListener("pointerenter", () => hover(number));
  row.addEventListener("pointerleave", () => hover(null));
  row.addEventListener("click", (event) => {
    if (event.target.closest("a")) return;
    pin(choice.pinned === number ? null : number);
  });
  row.querySelector("a").addEventListener("click", () => pin(number));
  row.querySelector("a").href = "#stage";
  row.querySelector(".number").before(marker(ways[number], ways[number].pareto ? "yes" : "no", 16));
}
for (const card of all(".card[data-way]")) {
  const number = Number(card.dataset.way);
  const link = html("a", { href: "#stage", class: "pick", "aria-label": `Compare ${ways[number].title} with the reference`, click: () => pin(number) });
  const pictures = card.querySelector(".three");
  pictures.before(link);
  link.append(pictures);
}
choice.listeners.push(showRows);
showRows();

// A link to a variant pins it.
const linked = /^#(?:way|row)-(\d+)$/.exec(location.hash);
if (linked && ways[linked[1]]) pin(Number(linked[1]));

// Paper shows all pictures, also those that were not scrolled to.
addEventListener("beforeprint", () => {
  for (const image of all("img[loading]")) image.loading = "eager";
});
