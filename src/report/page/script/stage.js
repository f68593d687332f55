
// ---- Stage: the picture, the truth and the difference, large.
const stage = { mode: "side", view: "color", bound: "seen", zoom: 1, center: [0.5, 0.5], flipped: false, share: 50, drawn: 0 };
const views = byId("views");
const model = (way) => page.models[way.model];

// The pixels of an embedded picture; each is decoded once, when it is first shown.
const decoded = new Map();
const pixels = async (index) => {
  if (!decoded.has(index)) {
    decoded.set(index, (async () => {
      const image = new Image();
      image.src = sources[index].src;
      await image.decode();
      const canvas = html("canvas", { width: image.naturalWidth, height: image.naturalHeight });
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, canvas.width, canvas.height);
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
  if (way.error.max_abs > 0) options.push([String(way.error.max_abs), `${scientific(way.error.max_abs, 2)}, the largest of this way`]);
  options.push([String(1 / 255), "1/255, a step of 8 bits"]);
  for (let decade = page.seen[1]; decade > page.coded[0] + 1; decade -= 1) options.push([String(Number(`1e${decade}`)), decadeText(decade)]);
  return options;
};

const paintDifference = (image, canvas) => {
  const context = canvas.getContext("2d");
  const painted = context.createImageData(image.width, image.height);
  const bound = Number(stage.bound);
  const colors = page.palette.map((color, code) => {
    const value = color && valueOf(code);
    if (!color || stage.bound === "seen" || value === null || value === 0) return hex(color || "#000000");
    return hex(page.palette[FIRST_SEEN + Math.round(Math.min(1, value / bound) * (LAST - FIRST_SEEN))]);
  });
  for (let at = 0; at < image.data.length; at += 4) {
    const color = colors[codeAt(image.data, at)];
    painted.data.set([color >> 16, (color >> 8) & 255, color & 255, 255], at);
  }
  context.putImageData(painted, 0, 0);
};

// ---- Frames: each holds one canvas, or two of which one is in front.
const frame = (label, layers, caption) => html("figure", { class: "view" },
  html("div", { class: "frame", role: "img", "aria-label": label }, layers, html("span", { class: "row", hidden: true }), html("span", { class: "cross", hidden: true })),
  html("figcaption", {}, caption));
const canvasFor = (image, className = "") => html("canvas", { width: image.width, height: image.height, class: className });
const painted = (image, className) => {
  const canvas = canvasFor(image, className);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
};

const ramp = () => {
  const stops = [];
  for (let code = FIRST_SEEN; code <= LAST; code += 12) stops.push(page.palette[code]);
  const [from, to] = stage.bound === "seen" ? [`${decadeText(page.seen[0])} or less`, decadeText(page.seen[1])] : ["0", `${stage.bound === String(1 / 255) ? "1/255" : scientific(Number(stage.bound), 1)} or more`];
  return html("span", { class: "bound" }, html("span", {}, from), html("i", { class: "ramp", style: `background:linear-gradient(to right,${stops.join()})` }), html("span", {}, to));
};

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
  const layer = canvasFor(difference);
  paintDifference(difference, layer);
  const what = isBands ? "Mach bands of " : "";
  const wayText = [html("strong", {}, `${way.number + 1} ${way.title}`), isBands ? `, its Mach bands: light and dark are ±${scientific(truth?.bound ?? 0)}` : ""];
  const truthText = [html("strong", {}, "The truth"), isBands ? ", its Mach bands" : ", in 64-bit on the CPU"];
  const third = frame(`Difference of ${way.title} from the truth`, [layer], [html("strong", {}, "Difference"), ramp(), html("span", {}, "Cyan is not compared.")]);
  if (!theirs) views.replaceChildren(frame(way.title, [painted(ours)], wayText), third);
  else if (stage.mode === "side") views.replaceChildren(frame(what + way.title, [painted(ours)], wayText), frame(what + "the truth", [painted(theirs)], truthText), third);
  else views.replaceChildren(stage.mode === "slider" ? slider(way, ours, theirs, wayText, truthText) : flip(way, ours, theirs, wayText, truthText), third);
  stage.images = [ours, theirs, difference];
  views.dataset.mode = theirs ? stage.mode : "side";
  fillBounds(way);
  showZoom();
  showRow(truth, ours);
};

const slider = (way, ours, theirs, wayText, truthText) => {
  const input = html("input", { type: "range", min: 0, max: 100, value: stage.share, "aria-label": "How much of the way is seen, the rest is the truth" });
  const made = frame(`${way.title} on the left, the truth on the right`, [painted(theirs), painted(ours, "over")], [html("span", { class: "ends" }, html("span", {}, "← ", wayText), html("span", {}, truthText, " →"))]);
  const move = () => {
    stage.share = Number(input.value);
    made.style.setProperty("--share", stage.share + "%");
  };
  input.addEventListener("input", move);
  made.querySelector(".frame").after(input);
  made.querySelector(".frame").append(html("span", { class: "edge" }));
  move();
  return made;
};

const flip = (way, ours, theirs, wayText, truthText) => {
  const made = frame(way.title, [painted(theirs), painted(ours, "top")], "");
  const button = html("button", { type: "button", id: "flip" }, "");
  const show = () => {
    made.classList.toggle("flipped", stage.flipped);
    made.querySelector(".frame").setAttribute("aria-label", stage.flipped ? "The truth" : way.title);
    button.textContent = stage.flipped ? "Show the way" : "Show the truth";
    made.querySelector("figcaption").replaceChildren(...(stage.flipped ? truthText : wayText), html("span", {}, " Space flips, too."));
  };
  button.addEventListener("click", () => {
    stage.flipped = !stage.flipped;
    show();
  });
  made.querySelector(".frame").after(button);
  show();
  return made;
};

const fillBounds = (way) => {
  const select = byId("stage-bound");
  const options = bounds(way);
  if (!options.some(([value]) => value === stage.bound)) stage.bound = "seen";
  select.replaceChildren(...options.map(([value, text]) => html("option", { value }, text)));
  select.value = stage.bound;
};

// ---- Zoom, and the pixel under the pointer.
const showZoom = () => {
  views.style.setProperty("--zoom", stage.zoom);
  views.style.setProperty("--left", stage.center[0] * 100 + "%");
  views.style.setProperty("--top", stage.center[1] * 100 + "%");
  byId("zoom-now").textContent = stage.zoom + "×";
  byId("zoom-out").disabled = stage.zoom <= 1;
  byId("zoom-in").disabled = stage.zoom >= 16;
};
const zoom = (factor) => {
  stage.zoom = Math.max(1, Math.min(16, stage.zoom * factor));
  showZoom();
};
const pan = (dx, dy) => {
  stage.center = [stage.center[0] + dx, stage.center[1] + dy].map((part) => Math.max(0, Math.min(1, part)));
  showZoom();
};
const inside = (event, target) => {
  const box = target.querySelector("canvas").getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
};

// The row of the profile is marked at both sides.
const showRow = (truth, image) => {
  if (!truth) return;
  for (const mark of all(".row", views)) {
    mark.hidden = stage.zoom > 1;
    mark.style.top = ((truth.row + 0.5) / page.factor / image.height) * 100 + "%";
  }
};

const readPixel = (x, y) => {
  const [ours, theirs, difference] = stage.images;
  const at = 4 * (y * ours.width + x);
  const color = (image) => `${image.data[at]} ${image.data[at + 1]} ${image.data[at + 2]}`;
  const code = codeAt(difference.data, at);
  const size = code === APART ? "not compared" : code === 0 ? "no difference" : `difference ${scientific(valueOf(code))}`;
  const scaled = page.factor > 1 ? ` (${page.factor} times smaller than drawn)` : "";
  return `Pixel ${x}, ${y}${scaled}: way ${color(ours)}, truth ${theirs ? color(theirs) : "–"} of 255; ${size}`;
};
const IDLE = "A pixel under the pointer is read here. Drag moves a picture that is zoomed; + and −, the arrows and Space work when the pictures have the focus.";
byId("readout").textContent = IDLE;
let drag = null;
views.addEventListener("pointerdown", (event) => {
  const target = event.target.closest(".frame");
  if (!target || event.button || stage.zoom === 1) return;
  drag = { x: event.clientX, y: event.clientY, width: target.clientWidth, height: target.clientHeight };
  target.setPointerCapture(event.pointerId);
});
views.addEventListener("pointermove", (event) => {
  const target = event.target.closest(".frame");
  if (drag) {
    const room = stage.zoom - 1;
    pan(-(event.clientX - drag.x) / drag.width / room, -(event.clientY - drag.y) / drag.height / room);
    [drag.x, drag.y] = [event.clientX, event.clientY];
  }
  if (!target || !stage.images) return;
  const { width, height } = stage.images[0];
  const [x, y] = inside(event, target).map((part, axis) => Math.floor(part * [width, height][axis]));
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  byId("readout").textContent = readPixel(x, y);
  for (const cross of all(".cross", views)) {
    const box = cross.parentElement.querySelector("canvas").getBoundingClientRect();
    const outer = cross.parentElement.getBoundingClientRect();
    cross.hidden = false;
    cross.style.left = box.left - outer.left + ((x + 0.5) / width) * box.width + "px";
    cross.style.top = box.top - outer.top + ((y + 0.5) / height) * box.height + "px";
  }
});
addEventListener("pointerup", () => { drag = null; });
views.addEventListener("pointerleave", () => {
  for (const cross of all(".cross", views)) cross.hidden = true;
  byId("readout").textContent = IDLE;
});
views.addEventListener("dblclick", (event) => {
  const target = event.target.closest(".frame");
  if (!target) return;
  stage.center = inside(event, target).map((part) => Math.max(0, Math.min(1, part)));
  zoom(2);
});
views.tabIndex = 0;
views.setAttribute("role", "group");
views.setAttribute("aria-label", "The pictures. Plus and minus zoom, arrows move, Space flips.");
views.addEventListener("keydown", (event) => {
  if (event.target !== views) return;
  const step = 0.25 / stage.zoom;
  const act = {
    "+": () => zoom(2), "=": () => zoom(2), "-": () => zoom(0.5),
    ArrowLeft: () => pan(-step, 0), ArrowRight: () => pan(step, 0), ArrowUp: () => pan(0, -step), ArrowDown: () => pan(0, step),
    " ": () => byId("flip")?.click(),
  }[event.key];
  if (!act || (event.key.startsWith("Arrow") && stage.zoom === 1)) return;
  event.preventDefault();
  act();
});
byId("zoom-in").addEventListener("click", () => zoom(2));
byId("zoom-out").addEventListener("click", () => zoom(0.5));

for (const input of all("#stage input[name]")) {
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
