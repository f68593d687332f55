
// ---- Stage: a variant's picture, the reference and the difference in the viewer.
const stage = { view: "color", bound: "seen", drawn: 0, difference: null };
const model = (way) => page.models[way.model];

// The pixels of an embedded picture; each is decoded once, when it is first shown.
const decoded = new Map();
const pixels = async (index) => {
  if (!decoded.has(index)) {
    decoded.set(index, (async () => {
      const image = new Image();
      image.src = sources[index].src;
      await image.decode();
      return pixelsOf(image);
    })());
    if (decoded.size > 24) decoded.delete(decoded.keys().next().value);
  }
  return decoded.get(index);
};

// ---- Differences: the color of a pixel is a code of its size.
const hex = (color) => parseInt(color.slice(1), 16);
const codes = new Map(page.palette.flatMap((color, code) => (color ? [[hex(color), code]] : [])));
const LAST = 250;
const APART = 255;
const valueOf = (code) => {
  if (code === 0 || code === APART) return code === 0 ? 0 : null;
  const [low, high] = page.coded;
  return 10 ** (low + ((code - 1) / (LAST - 1)) * (high - low));
};
const FIRST_SEEN = 1 + Math.ceil(((page.seen[0] - page.coded[0]) / (page.coded[1] - page.coded[0])) * (LAST - 1));
const codeAt = (data, at) => codes.get((data[at] << 16) | (data[at + 1] << 8) | data[at + 2]) ?? 0;

const bounds = (way) => {
  const options = [["seen", `${decadeText(page.seen[1])}, logarithmic from ${decadeText(page.seen[0])}`]];
  if (way.error.max_abs > 0) options.push([String(way.error.max_abs), `${scientific(way.error.max_abs, 2)}, the largest of this variant`]);
  options.push([String(1 / 255), "1/255, a step of 8 bits"]);
  for (let decade = page.seen[1]; decade > page.coded[0] + 1; decade -= 1) options.push([String(Number(`1e${decade}`)), decadeText(decade)]);
  return options;
};

const canvasFor = (image) => html("canvas", { width: image.width, height: image.height });
const painted = (image) => {
  const canvas = canvasFor(image);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
};
const paintedDifference = (image) => {
  const canvas = canvasFor(image);
  const context = canvas.getContext("2d");
  const target = context.createImageData(image.width, image.height);
  const bound = Number(stage.bound);
  const colors = page.palette.map((color, code) => {
    const value = color && valueOf(code);
    if (!color || stage.bound === "seen" || value === null || value === 0) return hex(color || "#000000");
    return hex(page.palette[FIRST_SEEN + Math.round(Math.min(1, value / bound) * (LAST - FIRST_SEEN))]);
  });
  for (let at = 0; at < image.data.length; at += 4) {
    const color = colors[codeAt(image.data, at)];
    target.data.set([color >> 16, (color >> 8) & 255, color & 255, 255], at);
  }
  context.putImageData(target, 0, 0);
  return canvas;
};

const ramp = () => {
  const stops = [];
  for (let code = FIRST_SEEN; code <= LAST; code += 12) stops.push(page.palette[code]);
  const [from, to] = stage.bound === "seen" ? [`${decadeText(page.seen[0])} or less`, decadeText(page.seen[1])] : ["0", `${stage.bound === String(1 / 255) ? "1/255" : scientific(Number(stage.bound), 1)} or more`];
  return html("span", { class: "bound" }, html("span", {}, from), html("i", { class: "ramp", style: `background:linear-gradient(to right,${stops.join()})` }), html("span", {}, to));
};

const tellDifference = (x, y, pictures, difference) => {
  if (!difference || !stage.difference) return tellPixel(x, y, pictures);
  const code = codeAt(stage.difference.data, 4 * (y * difference.width + x));
  const size = code === APART ? "not compared" : code === 0 ? "no difference" : `difference ${scientific(valueOf(code))}`;
  const scaled = page.factor > 1 ? ` (${page.factor} times smaller than drawn)` : "";
  const colors = pictures.map(({ name, image }) => `${name} ${colorAt(image, x, y).join(" ")}`).join(", ");
  return `Pixel ${x}, ${y}${scaled}: ${colors} of 255; ${size}`;
};
const viewer = makeViewer(byId("views"), { tell: tellDifference });
for (const frame of all(".frame", viewer.views)) frame.append(html("span", { class: "row", hidden: true }));

const drawStage = async () => {
  const way = ways[choice.stage];
  const drawing = (stage.drawn += 1);
  if (!way) return;
  byId("stage-way").value = way.number;
  const truth = model(way);
  const isBands = stage.view === "bands";
  const [ours, theirs, difference] = await Promise.all([
    pixels(isBands ? way.bands : way.picture),
    truth ? pixels(isBands ? truth.bands : truth.picture) : null,
    pixels(way.difference),
  ]);
  if (drawing !== stage.drawn) return;
  const what = isBands ? "Mach bands of " : "";
  const name = `${way.number + 1} ${way.title}`;
  fillView(viewer.figure.first, {
    name, layer: painted(ours), label: what + way.title,
    caption: [html("strong", {}, name), isBands ? `, its Mach bands: light and dark are ±${scientific(truth?.bound ?? 0)}` : ""],
  });
  fillView(viewer.figure.second, {
    name: "the reference", layer: theirs && painted(theirs), label: what + "the reference",
    caption: [html("strong", {}, "Reference"), isBands ? ", its Mach bands" : ", in 64-bit on the CPU"],
  });
  fillView(viewer.figure.third, {
    name: "difference", layer: paintedDifference(difference), label: `Difference of ${way.title} from the reference`,
    caption: [html("strong", {}, "Difference"), ramp(), html("span", {}, "Cyan is not compared.")],
  });
  stage.difference = difference;
  fillBounds(way);
  viewer.show();
  showRow();
};

const fillBounds = (way) => {
  const select = byId("stage-bound");
  const options = bounds(way);
  if (!options.some(([value]) => value === stage.bound)) stage.bound = "seen";
  select.replaceChildren(...options.map(([value, text]) => html("option", { value }, text)));
  select.value = stage.bound;
};

// The row of the profile is marked at both sides.
const showRow = () => {
  const truth = ways[choice.stage] && model(ways[choice.stage]);
  for (const mark of all(".row", viewer.views)) {
    mark.hidden = !truth || viewer.state.zoom > 1 || !stage.difference;
    if (!mark.hidden) mark.style.top = ((truth.row + 0.5) / page.factor / stage.difference.height) * 100 + "%";
  }
};
viewer.root.addEventListener("zoomed", showRow);

for (const input of all("#stage-controls input")) {
  input.addEventListener("change", () => {
    stage[input.name] = input.value;
    drawStage();
    showProfile();
  });
}
byId("stage-bound").addEventListener("change", (event) => {
  stage.bound = event.target.value;
  drawStage();
});
const byModel = report.truths.map((truth, index) => [truth.model, ways.filter((way) => way.model === index)]);
byId("stage-way").append(...byModel.map(([name, members]) => html("optgroup", { label: name }, members.map((way) => html("option", { value: way.number }, `${way.number + 1} ${way.title}`)))));
byId("stage-way").addEventListener("change", (event) => pin(Number(event.target.value)));
let staged = null;
const followChoice = () => {
  if (staged === choice.stage) return;
  staged = choice.stage;
  drawStage();
  showProfile();
};
