
// ---- Axes: what may be plotted, the front for it, and logarithmic scales.
const spelled = { k: 1e3, M: 1e6, G: 1e9, T: 1e12 };
const withPrefix = (value) => {
  const [prefix, factor] = Object.entries(spelled).reverse().find(([, factor]) => value >= factor) ?? ["", 1];
  return `${Number((value / factor).toPrecision(3))}${prefix && " " + prefix}`;
};
const asPower = (value) => {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  const factor = Number((value / 10 ** exponent).toPrecision(2));
  return factor === 1 ? `10${raised(exponent)}` : `${factor}·10${raised(exponent)}`;
};
const ACROSS = {
  work: { name: "operations", better: "more work", of: (way) => way.work.operations, tick: withPrefix },
  time: { name: "GPU time / baseline", better: "slower", of: (way) => way.ratio.median, tick: (value) => String(Number(value.toPrecision(3))) },
};
const UP = {
  rmse: { name: "RMSE", of: (way) => way.error.rmse },
  max_abs: { name: "largest error", of: (way) => way.error.max_abs },
  flip: { name: "FLIP", of: (way) => way.error.flip },
  max_ulp: { name: "ULP", of: (way) => way.error.max_ulp },
};

// For each variant "yes", "no" or "open", by the rules of the report, with the error that is plotted.
const front = (x, y) => {
  const error = (way) => UP[y].of(way) ?? NaN;
  const work = (way) => way.work.operations;
  return ways.map((way) => {
    if (way.unfit || way.model === null) return "no";
    const near = ways.filter((other) => other !== way && other.model === way.model && !other.unfit && error(other) <= error(way));
    if (x === "work") {
      const beaten = near.some((other) => work(other) <= work(way) && (work(other) !== work(way) || error(other) !== error(way)));
      return beaten ? "no" : "yes";
    }
    if (near.some((other) => other.faster_than.includes(way.number))) return "no";
    return near.every((other) => way.faster_than.includes(other.number)) ? "yes" : "open";
  });
};

// A logarithmic scale over positive values, from one place to another.
const logarithmic = (values, from, to, margin) => {
  const logs = values.filter((value) => value > 0 && Number.isFinite(value)).map(Math.log10);
  let [low, high] = logs.length ? [Math.min(...logs), Math.max(...logs)] : [-1, 1];
  const around = Math.max(margin, (high - low) * 0.06);
  [low, high] = [low - around, high + around];
  const place = (value) => from + ((Math.log10(value) - low) / (high - low)) * (to - from);
  const multiples = (steps) => {
    const found = [];
    for (let decade = Math.floor(low); decade <= Math.ceil(high); decade += 1) {
      for (const step of steps) {
        const value = decade < 0 ? step / 10 ** -decade : step * 10 ** decade;
        if (Math.log10(value) >= low && Math.log10(value) <= high) found.push(value);
      }
    }
    return found;
  };
  // The finest round steps of which no two are nearer than `apart`.
  const ticks = (apart) => {
    const steps = [[1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9], [1, 1.5, 2, 3, 4, 5, 7], [1, 2, 5], [1, 3], [1]].map(multiples);
    const far = (found) => found.every((tick, index) => index === 0 || Math.abs(place(tick) - place(found[index - 1])) >= apart);
    const fit = high - low > 4 ? null : steps.find((found) => found.length <= 12 && far(found));
    if (fit && fit.length > 1) return fit;
    const decades = steps[4];
    const every = Math.ceil(apart / (Math.abs(to - from) / (high - low)));
    const thinned = decades.filter((tick) => Math.round(Math.log10(tick)) % every === 0);
    return thinned.length ? thinned : steps[2].slice(0, 1);
  };
  return { place, ticks };
};

// ---- Marks: a shape for each kind.
const turn = (count, radius, inner = radius, start = -90) => {
  const corner = (index) => {
    const angle = ((start + (index * 360) / count) * Math.PI) / 180;
    const far = index % 2 ? inner : radius;
    return `${(far * Math.cos(angle)).toFixed(2)} ${(far * Math.sin(angle)).toFixed(2)}`;
  };
  return `M${Array.from({ length: count }, (_, index) => corner(index)).join("L")}Z`;
};
const SHAPES = [
  "M5.5 0A5.5 5.5 0 1 1 -5.5 0A5.5 5.5 0 1 1 5.5 0Z", // circle
  "M-5 -5H5V5H-5Z", // square
  turn(3, 7.2),
  turn(4, 7.2),
  turn(3, 7.2, 7.2, 90),
  turn(10, 8, 3.4), // star
  "M-2 -6.5H2V-2H6.5V2H2V6.5H-2V2H-6.5V-2H-2Z", // plus
  turn(6, 6.6),
  turn(8, 7.4, 2.6), // star of four
  turn(3, 7.2, 7.2, 0),
  turn(5, 6.6),
  "M-6 -6L6 6V-6L-6 6Z", // bow
  turn(3, 7.2, 7.2, 180),
  turn(8, 7.4, 2.6, -45),
  "M-6 -3.2H6V3.2H-6Z",
  "M-3.2 -6H3.2V6H-3.2Z",
];
const markOf = (shape) => SHAPES[shape % SHAPES.length];
const marker = (way, state = "yes", size = 18) =>
  svg("svg", { viewBox: "-9 -9 18 18", width: size, height: size, class: `key ${way.color}`, "aria-hidden": "true" },
    svg("path", { d: markOf(way.shape), class: `mark ${state}` }));
