// Opens the examples without a bundler in Chromium, and looks at what they draw: `node integrations/web/test/examples.mjs`.
//
// The arguments: the browser, the module playwright-core; those of Debian and of `npm install --prefix target/browser playwright-core`
// without them. `npm install` in examples/three comes first. Prints one JSON object of what it saw; the exit code is 1 if something is wrong.

import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";
import { root } from "./package.mjs";

const [executablePath = "/usr/bin/chromium", module = pathToFileURL(join(root, "target/browser/node_modules/playwright-core/index.mjs")).href] = process.argv.slice(2);
const { chromium } = await import(module);
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer((request, response) => {
  const path = join(root, normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)));
  if (!path.startsWith(root) || !existsSync(path) || !statSync(path).isFile()) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { "Content-Type": TYPES[extname(path)] ?? "text/plain" });
  createReadStream(path).pipe(response);
});
await new Promise((listening) => { server.listen(0, "127.0.0.1", listening); });
const address = `http://127.0.0.1:${server.address().port}/integrations/web/examples`;
// SwiftShader draws by WebGPU without a GPU.
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"] });
const seen = { errors: [] };
const open = async (path) => {
  const page = await browser.newPage();
  page.setDefaultTimeout(120000);
  page.on("pageerror", (error) => seen.errors.push(`${path}: ${error.message}`));
  await page.goto(`${address}/${path}`);
  await page.waitForFunction(() => document.body.dataset.ready);
  return page;
};
// How many colors a canvas shows, as it is on the screen.
const picture = async (page, selector) => (await page.locator(selector).screenshot()).toString("base64");
const pixels = (page, pictures) => page.evaluate(async (pictures) => {
  const read = async (text) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
  };
  return Promise.all(pictures.map(async (one) => Array.from(await read(one))));
}, pictures);
const colors = (data) => {
  const found = new Set();
  for (let at = 0; at < data.length; at += 4) found.add((data[at] << 16) | (data[at + 1] << 8) | data[at + 2]);
  return found.size;
};
try {
  const typed = await open("webgpu/index.html");
  seen.webgpu = await typed.evaluate(() => document.body.dataset.ready);
  const fragment = await typed.inputValue("#source");
  await typed.fill("#source", fragment.replace("length(at)", "lenght(at)"));
  seen.told = await typed.textContent("#said");
  await typed.fill("#source", fragment);
  await typed.waitForTimeout(500);
  const [rings] = await pixels(typed, [await picture(typed, "canvas")]);
  seen.rings = colors(rings);

  const three = await open("three/index.html#still");
  await three.evaluate(() => window.drawAt(1500));
  await three.waitForTimeout(500);
  const [before, after] = await pixels(three, [await picture(three, "#webgl"), await picture(three, "#webgpu")]);
  const far = before.filter((value, at) => Math.abs(value - after[at]) > 8).length;
  seen.three = { colors: [colors(before), colors(after)], far: far / before.length };

  const worker = await open("worker/index.html");
  seen.worker = await worker.evaluate(() => document.body.dataset.ready);
  const [ball] = await pixels(worker, [await picture(worker, "canvas")]);
  seen.ball = colors(ball);
} catch (error) {
  seen.errors.push(String(error));
}
await browser.close();
server.close();
console.log(JSON.stringify(seen, null, 2));
const hasGpu = seen.webgpu === "webgpu";
const isRight = seen.errors.length === 0 && /lenght/.test(seen.told) && seen.worker === "drawn" && seen.ball > 50
  && (!hasGpu || (seen.rings > 50 && seen.three.colors[1] > 50 && seen.three.far < 0.01));
process.exitCode = isRight ? 0 : 1;
