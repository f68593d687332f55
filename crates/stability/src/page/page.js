
// A card shows its pixel on the map.
for (const card of document.querySelectorAll(".card")) {
  const place = card.querySelector(".locator");
  const heat = byId(place.dataset.heat);
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
  const line = location.hash.length > 1 && byId(location.hash.slice(1));
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
