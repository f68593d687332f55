
// ---- Labels: texts at points that collide with nothing.
const measure = (() => {
  const context = document.createElement("canvas").getContext("2d");
  return (text, font) => {
    context.font = font;
    return context.measureText(text).width;
  };
})();

const SIDES = [[1, 0], [-1, 0], [1, -1], [1, 1], [-1, -1], [-1, 1], [0, -1], [0, 1]];

// Boxes for the labels of points in the order of their importance; null where there is no room.
const placeLabels = (points, { width, height, left, top, font, busy }) => {
  const taken = [...busy];
  for (const point of points) taken.push({ x: point.x - 9, y: point.y - 9, w: 18, h: 18 });
  const free = (box) =>
    box.x >= left && box.y >= top && box.x + box.w <= width && box.y + box.h <= height &&
    taken.every((other) => box.x + box.w <= other.x || other.x + other.w <= box.x || box.y + box.h <= other.y || other.y + other.h <= box.y);
  return points.map((point) => {
    if (!point.label) return null;
    const [w, h] = [measure(point.label, font) + 6, 16];
    for (const gap of [11, 22, 38]) {
      for (const [dx, dy] of SIDES) {
        const reach = dx && dy ? gap * 0.8 : gap;
        const box = {
          x: point.x + dx * reach - (dx < 0 ? w : dx === 0 ? w / 2 : 0),
          y: point.y + dy * reach - (dy < 0 ? h : dy === 0 ? h / 2 : 0),
          w, h, far: gap > 11,
        };
        if (!free(box)) continue;
        taken.push(box);
        return box;
      }
    }
    return null;
  });
};
