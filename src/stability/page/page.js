// Comforts of the page. Without this script, all pictures, figures and texts are there.
"use strict";
for (const control of document.querySelectorAll(".compare")) {
  const figure = control.closest("figure");
  const frame = figure.querySelector(".frame");
  const over = document.getElementById(control.dataset.exact).querySelector("img").cloneNode();
  const [slider, button] = [control.querySelector("input"), control.querySelector("button")];
  over.className = "over";
  over.alt = "";
  frame.append(over);
  control.hidden = false;
  const show = () => {
    frame.style.setProperty("--share", slider.value + "%");
    button.setAttribute("aria-pressed", String(slider.value === "100"));
  };
  slider.addEventListener("input", show);
  button.addEventListener("click", () => {
    slider.value = slider.value === "100" ? 0 : 100;
    show();
  });
  show();
}

// An enlarged picture goes back by a click, or by Escape.
const shrink = (figure) => {
  const link = figure.querySelector(".frame");
  location.replace(figure.querySelector(".close").getAttribute("href"));
  link.focus({ preventScroll: true });
};
for (const figure of document.querySelectorAll(".pictures figure")) {
  figure.querySelector(".frame").addEventListener("click", (event) => {
    if (!figure.matches(":target")) return;
    event.preventDefault();
    shrink(figure);
  });
}
addEventListener("keydown", (event) => {
  const figure = event.key === "Escape" && document.querySelector(".pictures figure:target");
  if (figure) shrink(figure);
});

// A card shows its pixel on the map.
for (const card of document.querySelectorAll(".card")) {
  const place = card.querySelector(".locator");
  const heat = document.getElementById(place.dataset.heat);
  const pin = heat.querySelector(`[data-cause="${card.id}"]`);
  const image = heat.querySelector("img").cloneNode();
  const ring = document.createElement("span");
  image.alt = "Where on the picture";
  ring.className = "pin";
  ring.style.left = place.dataset.left + "%";
  ring.style.top = place.dataset.top + "%";
  place.append(image, ring);
  place.hidden = false;
  const mark = (on) => {
    pin.classList.toggle("on", on);
    heat.classList.toggle("has-pins", on);
  };
  for (const [name, on] of [["pointerenter", true], ["focusin", true], ["pointerleave", false], ["focusout", false]]) {
    card.addEventListener(name, () => mark(on));
  }
}

// A link to a line opens the file, and the fold that it is in.
const reveal = () => {
  const line = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
  if (!line) return;
  let opened = false;
  for (let around = line.parentElement; around; around = around.parentElement) {
    if (around.tagName === "DETAILS" && !around.open) around.open = opened = true;
  }
  if (line.classList.contains("line") && line.tagName === "DETAILS") line.open = opened = true;
  if (opened) line.scrollIntoView({ block: "center" });
};
addEventListener("hashchange", reveal);
reveal();

// Up and Down go from line to line in a listing.
for (const listing of document.querySelectorAll(".listing")) {
  listing.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || event.target.tagName !== "SUMMARY") return;
    const lines = [...listing.querySelectorAll("summary")].filter((line) => line.offsetParent);
    const next = lines[lines.indexOf(event.target) + step];
    if (!next) return;
    event.preventDefault();
    next.focus();
  });
}

// The slider over the points of a sweep.
for (const series of document.querySelectorAll(".series")) {
  const points = [...series.querySelectorAll(".chosen .point")];
  const [row, slider, told] = [series.querySelector(".slider"), series.querySelector("input"), series.querySelector("output")];
  if (points.length < 2) continue;
  const marks = [...series.parentElement.querySelectorAll(".plot .at[data-point]")];
  const show = () => {
    points.forEach((point, index) => { point.hidden = index !== Number(slider.value); });
    const point = points[Number(slider.value)];
    told.textContent = point.dataset.title;
    slider.setAttribute("aria-valuetext", point.dataset.title);
    for (const mark of marks) mark.classList.toggle("on", mark.dataset.point === point.dataset.index);
  };
  for (const mark of marks) {
    mark.classList.add("pickable");
    mark.addEventListener("click", () => {
      slider.value = points.findIndex((point) => point.dataset.index === mark.dataset.point);
      show();
    });
  }
  slider.value = series.dataset.worst;
  slider.addEventListener("input", show);
  row.hidden = false;
  show();
}
