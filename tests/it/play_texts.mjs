// Checks what the page of `glisten play` knows of texts and numbers, without a browser. The argument: its script `texts.js`. Prints one JSON object.

import { readFileSync } from "node:fs";
const script = readFileSync(process.argv[2], "utf8");
const { plain, plainPlaces, restored, moving, typedNumber, rounded, written } = new Function(`${script}; return { plain, plainPlaces, restored, moving, typedNumber, rounded, written };`)();
const raw = "a\r\nb\nc\r\n\rd";
const move = moving("a = 1\nb = 22\n", "a = 1\nxx\nb = 22\n");
const touched = moving("b = 22", "b = 225");
console.log(JSON.stringify({
  plain: plain(raw),
  places: [0, 3, 5, 8].map(plainPlaces(raw)),
  same: restored(plain(raw), raw) === raw,
  // Lines that stay keep their endings; a new one has that of most lines.
  restored: restored("a\nb\nnew\nc\n\nd", raw),
  unix: restored("a\nb\n", "a\n"),
  moved: [move([4, 5]), move([10, 12]), move(null), touched([4, 6]), touched([0, 1])],
  typed: ["1e30", "0.00002", "1e-7", "5", "-.5", "007", "5.", "+2", "", "-", "1e", "x"].map((text) => typedNumber(text, "number") ?? null),
  whole: ["3", "1e3", "2.5", "-0"].map((text) => typedNumber(text, "integer")),
  // A slider's values are no longer than its steps need.
  slid: [[0.30000000000000004, 0.0025], [0.7525, 0.0025], [3.0000000000000004e-9, 2.5e-12], [5e29, 2.5e27], [12, 0.05], [-0, 0.1]].map(([value, step]) => written(rounded(value, step), "number")),
  kinds: [written(1, "bool"), written(0, "bool"), written(2.6, "integer")],
}));
