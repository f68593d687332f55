// The entry for browsers.

import { browser } from "./browser.js";

export { GlistenError } from "./module.js";
export const { init, compile, lint, fix, reflect, upgrade, format, stageOf, versions, render } = browser(new URL("./reference.wasm", import.meta.url));
