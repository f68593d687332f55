
// A picture opens in the viewer, with the one that it should be like, if there is one. Without this script it opens as a file.
const dialog = byId("opened");
const opened = makeViewer(byId("large"));
const load = async (src, alt) => {
  const image = html("img", { src, alt });
  await image.decode();
  return image;
};
const open = async (link) => {
  const { title, other, otherTitle, difference, factor } = link.dataset;
  const [first, second, third] = await Promise.all([load(link.href, title), other ? load(other, otherTitle) : null, difference ? load(difference, "difference") : null]);
  fillView(opened.figure.first, { name: title, layer: first, caption: html("strong", {}, title) });
  fillView(opened.figure.second, { name: otherTitle, layer: second, caption: html("strong", {}, otherTitle ?? "") });
  fillView(opened.figure.third, { name: "difference", layer: third, caption: [html("strong", {}, "Difference"), ` of linear light, shown ${factor} times as bright`] });
  opened.state.mode = "side";
  opened.state.zoom = 1;
  opened.show();
  dialog.showModal();
  opened.views.focus({ preventScroll: true });
};
for (const link of all("a.picture")) {
  link.addEventListener("click", (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    open(link);
  });
}
dialog.querySelector(".close").addEventListener("click", () => dialog.close());
dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });

// A text that several cards show is in the page once. The others get a copy when they are opened; without this script they have a link.
for (const again of all("details[data-source]")) {
  again.addEventListener("toggle", () => {
    const text = byId(again.dataset.source)?.querySelector("pre");
    if (text) again.querySelector("p").replaceWith(text.cloneNode(true));
  }, { once: true });
}
