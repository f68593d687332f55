
// ---- Labels: texts at points that collide with nothing.
const measure = (() => {
  const context = document.createElement("canvas").getContext("2d");
  return (text, font) => {
    context.font = font;
    return context.measureText(text).width;
  };
})();

const SIDES = [[1, 0], [-1, 0], [1, -1], [1, 1], [-1, -1], [-1, 1], [0, -1], [0, 1]];

// Whether a segment touches a box (Liang and Barsky).
const crosses = ([x0, y0, x1, y1], box) => {
  let [from, to] = [0, 1];
  for (const [p, q] of [[x0 - x1, x0 - box.x], [x1 - x0, box.x + box.w - x0], [y0 - y1, y0 - box.y], [y1 - y0, box.y + box.h - y0]]) {
    if (p === 0 && q < 0) return false;
    if (p < 0) from = Math.max(from, q / p);
    if (p > 0) to = Math.min(to, q / p);
  }
  return from <= to;
};

// Boxes for the labels of points in the order of their importance; null where there is no room. No box is on another or on a
// point; one that crosses few lines is preferred to one that is near.
const placeLabels = (points, { width, height, left, top, font, lines }) => {
  const taken = points.map((point) => ({ x: point.x - 10, y: point.y - 10, w: 20, h: 20 }));
  const free = (box) =>
    box.x >= left && box.y >= top && box.x + box.w <= width && box.y + box.h <= height &&
    taken.every((other) => box.x + box.w <= other.x || other.x + other.w <= box.x || box.y + box.h <= other.y || other.y + other.h <= box.y);
  return points.map((point) => {
    if (!point.label) return null;
    const [w, h] = [measure(point.label, font(point)) + 7, 16];
    let best = null;
    for (const gap of [12, 22, 36, 54]) {
      for (const [dx, dy] of SIDES) {
        const reach = dx && dy ? gap * 0.8 : gap;
        const box = {
          x: point.x + dx * reach - (dx < 0 ? w : dx === 0 ? w / 2 : 0),
          y: point.y + dy * reach - (dy < 0 ? h : dy === 0 ? h / 2 : 0),
          w, h, far: gap > 12,
        };
        if (!free(box)) continue;
        const cost = 2 * lines.filter((line) => crosses(line, box)).length + gap / 11;
        if (!best || cost < best.cost) best = { cost, box };
      }
    }
    if (best) taken.push(best.box);
    return best?.box ?? null;
  });
};
