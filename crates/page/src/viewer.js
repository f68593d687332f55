// ---- The viewer: up to two pictures and what differs, next to each other or one over the other, zoomed, and read.
//
// A viewer is an element `.viewer` with `.views`, which holds figures `.view`: `.first`, `.second` and `.third`, all but the first
// of which may be missing. A figure has a `.frame`, a `.sheet` in it with the picture, and a caption. Without this script all
// pictures are seen; with it, two of them can lie one over the other.

// The pixels of an image or a canvas; null where the browser keeps them (a file next to a page that was opened from a disk).
const pixelsOf = (layer) => {
  if (!layer || (layer.tagName === "IMG" && !layer.naturalWidth)) return null;
  const [width, height] = layer.tagName === "IMG" ? [layer.naturalWidth, layer.naturalHeight] : [layer.width, layer.height];
  try {
    const canvas = html("canvas", { width, height });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(layer, 0, 0);
    return context.getImageData(0, 0, width, height);
  } catch {
    return { width, height, data: null };
  }
};
const copyOf = (layer) => {
  const copy = layer.cloneNode();
  copy.removeAttribute("id");
  if (layer.tagName === "CANVAS") copy.getContext("2d").drawImage(layer, 0, 0);
  return copy;
};
const colorAt = (image, x, y) => {
  const at = 4 * (y * image.width + x);
  const [red, green, blue, alpha] = image.data.slice(at, at + 4);
  return alpha === 255 ? [red, green, blue] : [red, green, blue, alpha];
};

// What the readout tells of a pixel: of the pictures that have it, the bytes, and how far the first two are apart.
const tellPixel = (x, y, pictures) => {
  const known = pictures.filter(({ image }) => image?.data && x < image.width && y < image.height);
  const colors = known.map(({ name, image }) => ({ name, color: colorAt(image, x, y) }));
  const told = colors.map(({ name, color }) => `${name} ${color.join(" ")}`).join(", ");
  if (!told) return `Pixel ${x}, ${y}`;
  const [one, other] = colors.map(({ color }) => color);
  const apart = colors.length > 1 ? Math.max(...one.map((channel, index) => Math.abs(channel - (other[index] ?? 255)))) : null;
  const difference = apart === null ? "" : apart === 0 ? "; no difference in 8 bits" : `; ${apart} of 255 apart`;
  return `Pixel ${x}, ${y}: ${told} of 255${difference}`;
};

const makeViewer = (root, { tell = tellPixel } = {}) => {
  const views = root.querySelector(".views");
  const figure = Object.fromEntries(["first", "second", "third"].map((place) => [place, views.querySelector(`.view.${place}`)]));
  const state = { mode: "side", zoom: 1, center: [0.5, 0.5], share: 50, flipped: false, images: {} };
  const sheet = (place) => figure[place]?.querySelector(".sheet");
  const layer = (place) => sheet(place)?.querySelector(":scope > :is(img, canvas):not(.under)") ?? null;
  const nameOf = (place) => figure[place]?.dataset.name ?? "";
  const image = (place) => {
    const now = layer(place);
    if (!now) return null;
    if (state.images[place]?.of !== now) state.images[place] = { of: now, image: pixelsOf(now) };
    if (!state.images[place].image) delete state.images[place];
    return state.images[place]?.image ?? null;
  };
  const sizeOf = (place) => {
    const now = layer(place);
    return now ? [now.naturalWidth || now.width, now.naturalHeight || now.height] : null;
  };
  const canOverlay = () => {
    const [one, other] = [sizeOf("first"), sizeOf("second")];
    return Boolean(one && other && one[0] === other[0] && one[1] === other[1]);
  };

  // Controls.
  const key = `mode-${(makeViewer.count = (makeViewer.count ?? 0) + 1)}`;
  const mode = (value, text) => html("label", {}, html("input", { type: "radio", name: key, value, checked: value === "side", change: () => setMode(value) }), text);
  const modes = html("fieldset", {}, html("legend", {}, "Compare"), mode("side", "Side by side"), mode("slider", "Slider"), mode("flip", "Flip"));
  const smaller = html("button", { type: "button", "aria-label": "Zoom out", click: () => zoom(0.5) }, "−");
  const larger = html("button", { type: "button", "aria-label": "Zoom in", click: () => zoom(2) }, "+");
  const zoomed = html("output", {}, "1×");
  const enlarge = html("button", { type: "button", "aria-pressed": "false", click: () => setLarge(!root.classList.contains("large")) }, "Enlarge");
  const controls = html("div", { class: "controls" }, modes, html("fieldset", {}, html("legend", {}, "Zoom"), smaller, zoomed, larger), enlarge);
  const readout = html("p", { class: "readout" });
  const slider = html("input", { type: "range", min: 0, max: 100, step: "any", input: () => setShare(Number(slider.value)) });
  const flip = html("button", { type: "button", click: () => setFlipped(!state.flipped) });
  const over = html("figcaption", { class: "of-both" });
  const edge = html("span", { class: "edge", hidden: true });
  views.before(controls);
  views.after(readout);
  figure.first.querySelector(".frame").append(edge);
  figure.first.querySelector(".frame").after(slider, flip, over);
  for (const frame of all(".frame", views)) frame.append(html("span", { class: "cross", hidden: true }));

  const IDLE = () => `Point at a pixel to read it. Drag moves a zoomed picture${canOverlay() ? " or the slider" : ""}. When the pictures have the focus: + and − zoom, arrows move${canOverlay() ? ", Space flips, 1 to 3 choose how to compare" : ""}.`;

  // What is seen follows from the state alone.
  const show = () => {
    const both = canOverlay();
    if (!both) state.mode = "side";
    const { mode } = state;
    modes.hidden = !both;
    views.dataset.mode = mode;
    views.style.setProperty("--columns", Object.values(figure).filter((one) => one && !one.hidden).length - (mode === "side" || !figure.second ? 0 : 1));
    const size = sizeOf("first");
    if (size) root.style.setProperty("--aspect", size[0] / size[1]);
    for (const input of all("input", modes)) input.checked = input.value === mode;
    for (const old of all(".under", views)) old.remove();
    layer("first")?.classList.toggle("over", mode !== "side");
    if (mode !== "side") {
      const under = copyOf(layer("second"));
      under.classList.add("under");
      sheet("first").prepend(under);
    }
    if (figure.second) figure.second.classList.toggle("covered", mode !== "side");
    const own = figure.first.querySelector("figcaption:not(.of-both)");
    own.hidden = mode !== "side";
    over.hidden = mode === "side";
    edge.hidden = slider.hidden = mode !== "slider";
    flip.hidden = mode !== "flip";
    setShare(state.share);
    setFlipped(state.flipped);
    setZoom();
    readout.textContent = IDLE();
  };
  const setMode = (mode) => {
    state.mode = mode;
    show();
  };
  const setShare = (share) => {
    state.share = Math.max(0, Math.min(100, share));
    slider.value = state.share;
    slider.setAttribute("aria-label", `How much is ${nameOf("first")}; the rest is ${nameOf("second")}`);
    views.style.setProperty("--share", state.share + "%");
    if (state.mode === "slider") {
      over.replaceChildren(html("span", { class: "ends" }, html("span", {}, "← ", html("strong", {}, nameOf("first"))), html("span", {}, html("strong", {}, nameOf("second")), " →")));
    }
  };
  const setFlipped = (flipped) => {
    state.flipped = flipped && state.mode === "flip";
    views.classList.toggle("flipped", state.flipped);
    if (state.mode !== "flip") return;
    const [now, next] = state.flipped ? ["second", "first"] : ["first", "second"];
    flip.textContent = `Show ${nameOf(next)}`;
    over.replaceChildren(html("strong", {}, nameOf(now)), ". Space flips, too.");
  };
  const setZoom = () => {
    views.style.setProperty("--zoom", state.zoom);
    views.style.setProperty("--left", state.center[0] * 100 + "%");
    views.style.setProperty("--top", state.center[1] * 100 + "%");
    views.classList.toggle("zoomed", state.zoom > 1);
    zoomed.textContent = state.zoom + "×";
    smaller.disabled = state.zoom <= 1;
    larger.disabled = state.zoom >= 16;
    root.dispatchEvent(new CustomEvent("zoomed", { detail: state.zoom }));
  };
  const zoom = (factor) => {
    state.zoom = Math.max(1, Math.min(16, state.zoom * factor));
    setZoom();
  };
  const pan = (dx, dy) => {
    state.center = [state.center[0] + dx, state.center[1] + dy].map((part) => Math.max(0, Math.min(1, part)));
    setZoom();
  };
  const setLarge = (large) => {
    root.classList.toggle("large", large);
    enlarge.setAttribute("aria-pressed", String(large));
    enlarge.textContent = large ? "Close" : "Enlarge";
    (large ? views : enlarge).focus({ preventScroll: true });
  };

  // The pixel under the pointer, in all figures.
  const inside = (event, frame) => {
    const box = frame.querySelector(".sheet").getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };
  const read = (event, frame) => {
    const here = Object.keys(figure).find((place) => figure[place]?.contains(frame));
    const size = sizeOf(here);
    if (!size) return;
    const [x, y] = inside(event, frame).map((part, axis) => Math.floor(part * size[axis]));
    if (x < 0 || y < 0 || x >= size[0] || y >= size[1]) return;
    const alike = ["first", "second"].filter((place) => sizeOf(place)?.join() === size.join());
    readout.textContent = tell(x, y, alike.map((place) => ({ name: nameOf(place), image: image(place) })), image("third"));
    for (const cross of all(".cross", views)) {
      const box = cross.parentElement.querySelector(".sheet").getBoundingClientRect();
      const outer = cross.parentElement.getBoundingClientRect();
      cross.hidden = false;
      cross.style.left = box.left - outer.left + ((x + 0.5) / size[0]) * box.width + "px";
      cross.style.top = box.top - outer.top + ((y + 0.5) / size[1]) * box.height + "px";
    }
  };
  const slide = (event, frame) => {
    const box = frame.getBoundingClientRect();
    setShare(((event.clientX - box.left) / box.width) * 100);
  };
  let drag = null;
  views.addEventListener("pointerdown", (event) => {
    const frame = event.target.closest(".frame");
    if (!frame || event.button) return;
    const slides = state.mode === "slider" && state.zoom === 1 && figure.first.contains(frame);
    if (!slides && state.zoom === 1) return;
    drag = { slides, x: event.clientX, y: event.clientY, width: frame.clientWidth, height: frame.clientHeight, frame };
    if (slides) slide(event, frame);
    frame.setPointerCapture(event.pointerId);
  });
  views.addEventListener("pointermove", (event) => {
    if (drag?.slides) slide(event, drag.frame);
    else if (drag) {
      const room = state.zoom - 1;
      pan(-(event.clientX - drag.x) / drag.width / room, -(event.clientY - drag.y) / drag.height / room);
      [drag.x, drag.y] = [event.clientX, event.clientY];
    }
    const frame = event.target.closest(".frame");
    if (frame) read(event, frame);
  });
  for (const name of ["pointerup", "pointercancel"]) views.addEventListener(name, () => { drag = null; });
  views.addEventListener("dragstart", (event) => event.preventDefault());
  views.addEventListener("pointerleave", () => {
    for (const cross of all(".cross", views)) cross.hidden = true;
    readout.textContent = IDLE();
  });
  views.addEventListener("dblclick", (event) => {
    const frame = event.target.closest(".frame");
    if (!frame) return;
    state.center = inside(event, frame).map((part) => Math.max(0, Math.min(1, part)));
    zoom(2);
  });

  // The keyboard.
  views.tabIndex = 0;
  views.setAttribute("role", "group");
  views.setAttribute("aria-label", "Pictures. Plus and minus zoom, arrows move, Space flips, 1 to 3 choose how to compare.");
  const move = (dx, dy) => {
    if (state.zoom > 1) pan((dx * 0.25) / state.zoom, (dy * 0.25) / state.zoom);
    else if (state.mode === "slider" && dx) setShare(state.share + 2 * dx);
    else return false;
    return true;
  };
  views.addEventListener("keydown", (event) => {
    if (event.target !== views || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = {
      "+": () => zoom(2), "=": () => zoom(2), "-": () => zoom(0.5),
      ArrowLeft: () => move(-1, 0), ArrowRight: () => move(1, 0), ArrowUp: () => move(0, -1), ArrowDown: () => move(0, 1),
      1: () => setMode("side"), 2: () => setMode("slider"), 3: () => setMode("flip"),
      " ": () => {
        if (!canOverlay()) return false;
        if (state.mode !== "flip") setMode("flip");
        setFlipped(!state.flipped);
      },
    }[event.key];
    if (act && act() !== false) event.preventDefault();
  });
  root.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !root.classList.contains("large")) return;
    event.stopPropagation();
    setLarge(false);
  });
  for (const picture of all("img", views)) if (!picture.complete) picture.addEventListener("load", show, { once: true });

  show();
  return { root, views, state, figure, show, image };
};

// A figure's picture and caption, set anew.
const fillView = (figure, { name, layer, caption, label = name }) => {
  figure.hidden = !layer;
  if (!layer) {
    figure.querySelector(".sheet :is(img, canvas)")?.remove();
    return;
  }
  figure.dataset.name = name;
  const sheet = figure.querySelector(".sheet");
  for (const old of all(":scope > :is(img, canvas)", sheet)) old.remove();
  sheet.prepend(layer);
  figure.querySelector(".frame").setAttribute("aria-label", label);
  figure.querySelector("figcaption:not(.of-both)").replaceChildren(...[caption].flat());
};

// Viewers that the page has with their pictures in them.
const viewers = new Map(all(".viewer[data-whole]").map((root) => [root, makeViewer(root)]));
