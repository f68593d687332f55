// The entry for browsers.

import { browser } from "./browser.js";

export { GlistenError } from "./module.js";
export const { init, compile, lint, fix, reflect, upgrade, format, stageOf, versions } = browser(new URL("./compiler.wasm", import.meta.url));
