// The page: it asks a worker for a picture at each movement of the slider, and never waits for it.

const worker = new Worker("worker.js", { type: "module" });
const context = document.querySelector("canvas").getContext("2d");
const slider = document.querySelector("#shininess");
const said = document.querySelector("#said");

// One question is under way; the newest value waits.
let isBusy = false, waiting = null;
const ask = (shininess) => {
  if (isBusy) { waiting = shininess; return; }
  isBusy = true;
  worker.postMessage({ shininess });
};
worker.onmessage = ({ data: { picture, milliseconds, error } }) => {
  isBusy = false;
  if (picture) context.putImageData(new ImageData(picture.data, picture.width, picture.height), 0, 0);
  said.textContent = error ?? `${Math.round(milliseconds)} ms`;
  document.body.dataset.ready = error ? "error" : "drawn";
  if (waiting !== null) { const next = waiting; waiting = null; ask(next); }
};
slider.addEventListener("input", () => ask(Number(slider.value)));
ask(Number(slider.value));
