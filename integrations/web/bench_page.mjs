// How soon the page of `glisten play` answers, in Chromium: `node integrations/web/bench_page.mjs [PROGRAM] [FOLDER]`.
//
// PROGRAM is glisten (target/release/glisten), FOLDER has scenes (fixtures/scenes/library). For the page that the program serves, and for the page
// that computes by itself if `integrations/web/make page` has built its module: the time from a key to its finding, from a fix of the text to the
// picture of the reference; of each scene, from its choice to its first look and to its picture; and, while a slider moves, the pictures a second of
// the reference and of the GPU (SwiftShader in the page, lavapipe from the program), with the time that the page itself takes of each: all but the
// GPU's. It needs Debian's chromium, and playwright-core in target/browser. Medians and the slowest tenth, in ms.

import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));
const [program = join(root, "target/release/glisten"), given = join(root, "fixtures/scenes/library")] = process.argv.slice(2);
const folder = resolve(given);
const { chromium } = await import(pathToFileURL(join(root, "target/browser/node_modules/playwright-core/index.mjs")).href);
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"] });
const KEYS = 15;
const at = (times, part) => [...times].sort((a, b) => a - b)[Math.min(times.length - 1, Math.floor(times.length * part))];
const told = (name, times) => console.log(`  ${name.padEnd(52)} ${String(times.length).padStart(4)} ${at(times, 0.5).toFixed(0).padStart(7)} ${at(times, 0.9).toFixed(0).padStart(7)}`);

/** The time from a key to the first change of an element after it, in the page. */
const answered = async (page, key, watched) => {
  // The page watches before the key comes.
  await page.evaluate((watched) => {
    window.answer = new Promise((done, failed) => {
      setTimeout(() => failed(new Error(`${watched} did not change within 30 s`)), 30000);
      let begun = null;
      addEventListener("keydown", () => { begun ??= performance.now(); }, { once: true, capture: true });
      const observer = new MutationObserver(() => {
        if (begun === null) return;
        observer.disconnect();
        done(performance.now() - begun);
      });
      observer.observe(document.querySelector(watched), { subtree: true, childList: true, characterData: true });
    });
  }, watched);
  await page.keyboard.press(key);
  return page.evaluate(() => window.answer);
};

const measure = async (name, address) => {
  const page = await browser.newPage({ viewport: { width: 1400, height: 1000 } });
  page.setDefaultTimeout(120000);
  await page.goto(address);
  await page.waitForSelector("#pictures img");
  console.log(`${name}\n  ${"".padEnd(52)}    n  median     9/10`);
  const idle = () => page.waitForTimeout(900);
  const scenes = await page.locator("#scenes optgroup[label=Scenes] option").evaluateAll((options) => options.map((option) => option.value));
  // Shows a scene; returns the times to its first look, if it has one, and to its picture.
  const shows = async (scene) => {
    if ((await page.locator("#scenes").inputValue()) === scene) return null;
    return page.evaluate((scene) => new Promise((done) => {
      const begun = performance.now();
      let first = null;
      const observer = new MutationObserver(() => {
        const text = document.querySelector("#drawn").textContent;
        if (/first look/.test(text)) first ??= performance.now() - begun;
        else { observer.disconnect(); done({ first, whole: performance.now() - begun }); }
      });
      observer.observe(document.querySelector("#drawn"), { subtree: true, childList: true, characterData: true });
      const scenes = document.querySelector("#scenes");
      scenes.value = scene;
      scenes.dispatchEvent(new Event("change", { bubbles: true }));
    }), scene);
  };
  // A scene with a fragment shader of its own, which can be changed.
  const fragment = page.locator("#files button:not(.is-fixed)", { hasText: ".frag" }).first();
  let tried = 0;
  while (tried < scenes.length && !(await fragment.count())) { await shows(scenes[tried]); tried += 1; }
  if (await fragment.count()) {
    await fragment.click();
    await page.locator("#editor .cm-content").click();
    await page.keyboard.press("Control+End");
    const [wrong, right] = [[], []];
    for (let key = 0; key < KEYS; key += 1) {
      await idle();
      wrong.push(await answered(page, "q", "#findings"));
      await idle();
      right.push(await answered(page, "Backspace", "#drawn"));
    }
    told("from a key to its finding", wrong);
    told("from a fix to the picture", right);
  }
  // Each scene once: what the page says of the reference's picture.
  const pictures = [], soon = [], whole = [];
  for (const scene of scenes) {
    const times = await shows(scene);
    if (times) { soon.push(times.first ?? times.whole); whole.push(times.whole); }
    const [, width, height, time] = /(\d+) × (\d+).* in (\d+) ms/.exec(await page.locator("#drawn").textContent()) ?? [];
    if (time !== undefined) pictures.push({ scene, time: Number(time), pixels: width * height });
  }
  if (soon.length) {
    told("from the choice of a scene to its first look", soon);
    told("the same to its picture", whole);
  }
  told("the reference's picture of a scene", pictures.map(({ time }) => time));
  told("the same for 256 × 256 pixels", pictures.map(({ time, pixels }) => (time * 256 * 256) / pixels));
  const [slowest] = pictures.sort((a, b) => b.time / b.pixels - a.time / a.pixels);
  if (slowest) console.log(`  the slowest for its size is ${slowest.scene.split("/").at(-1)}: ${slowest.time} ms for ${slowest.pixels} pixels`);
  // A slider that moves: pictures a second.
  const slider = page.locator("#controls input[type=range]").first();
  for (const by of ["reference", "gpu"]) {
    await page.check(`input[name=by][value=${by}]`);
    await page.waitForTimeout(3000);
    const shown = await slider.evaluate((slider) => new Promise((done) => {
      const shown = [];
      const drawn = document.querySelector("#drawn");
      const observer = new MutationObserver(() => shown.push([performance.now(), Number(/in (\d+) ms/.exec(drawn.textContent)?.[1])]));
      observer.observe(drawn, { subtree: true, childList: true, characterData: true });
      const begun = performance.now();
      const [low, high] = [Number(slider.min), Number(slider.max)];
      const move = () => {
        const passed = performance.now() - begun;
        if (passed > 4000) { observer.disconnect(); done(shown); return; }
        slider.value = low + (high - low) * (0.5 + 0.4 * Math.sin(passed / 300));
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        requestAnimationFrame(move);
      };
      move();
    }));
    // The first pictures make the programs.
    const steady = shown.slice(Math.floor(shown.length / 4));
    const whole = steady.slice(1).map(([now], index) => now - steady[index][0]);
    const own = steady.slice(1).map(([now, drawing], index) => now - steady[index][0] - drawing);
    if (!whole.length) { console.log(`  while a slider moves, by ${by}: not drawn`); continue; }
    console.log(`  ${`pictures a second while a slider moves, by ${by}`.padEnd(52)} ${String(whole.length).padStart(4)} ${(1000 * whole.length / whole.reduce((sum, one) => sum + one)).toFixed(1).padStart(7)}`);
    told(`the page's own time of such a picture, by ${by}`, own);
  }
  await page.close();
};

const server = spawn(program, ["play", folder], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((found) => {
  let text = "";
  server.stdout.on("data", (part) => { text += part; const [url] = /http:\S+/.exec(text) ?? []; if (url) found(url); });
});
await measure("the page that the program serves", address);
server.kill();

const module = join(root, "target/web/play.wasm.gz");
if (existsSync(module)) {
  const place = mkdtempSync(join(tmpdir(), "glisten-"));
  const file = join(place, "page.html");
  const made = spawnSync(program, ["play", folder, "--export", file, "--module", module], { encoding: "utf8" });
  if (made.status === 0) await measure("the page that computes by itself", pathToFileURL(file).href);
  else console.log(made.stderr);
  rmSync(place, { recursive: true });
} else console.log("The page that computes by itself is not measured: `integrations/web/make page` builds its module.");
await browser.close();
process.exit();
