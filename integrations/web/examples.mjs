// Opens the examples without a bundler in Chromium, and looks at what they draw: `node integrations/web/examples.mjs`.
//
// The arguments: the browser, the module playwright-core; those of Debian and of `npm install --prefix target/browser playwright-core`
// without them. `npm install` in examples/three comes first. Prints one JSON object of what it saw; the exit code is 1 if something is wrong.

import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";
import { root } from "./test/package.mjs";

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
// A canvas that nobody sees need not be presented: its frames go to a texture, which is read back.
const readable = () => {
  const frames = new WeakMap();
  const { configure } = GPUCanvasContext.prototype;
  GPUCanvasContext.prototype.configure = function (given) {
    configure.call(this, given);
    const size = [this.canvas.width, this.canvas.height];
    const texture = given.device.createTexture({ size, format: given.format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
    frames.set(this.canvas, { ...given, texture });
  };
  GPUCanvasContext.prototype.getCurrentTexture = function () { return frames.get(this.canvas).texture; };
  window.frameOf = async (canvas) => {
    const { device, format, texture } = frames.get(canvas);
    const { width, height } = texture;
    const stride = Math.ceil((width * 4) / 256) * 256;
    const buffer = device.createBuffer({ size: stride * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: stride }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await buffer.mapAsync(GPUMapMode.READ);
    const bytes = new Uint8Array(buffer.getMappedRange());
    const order = format.startsWith("bgra") ? [2, 1, 0, 3] : [0, 1, 2, 3];
    return Array.from({ length: width * height * 4 }, (_, at) => {
      const [pixel, channel] = [at >> 2, at & 3];
      return bytes[Math.floor(pixel / width) * stride + (pixel % width) * 4 + order[channel]];
    });
  };
};
const open = async (path) => {
  const page = await browser.newPage();
  page.setDefaultTimeout(120000);
  page.on("pageerror", (error) => seen.errors.push(`${path}: ${error.message}`));
  await page.addInitScript(readable);
  await page.goto(`${address}/${path}`);
  await page.waitForFunction(() => document.body.dataset.ready);
  return page;
};
// The pixels of canvases after `draw`, in the frame in which they are drawn.
const pixels = (page, selectors, draw = "") => page.evaluate(async ([selectors, draw]) => {
  const read = (canvas) => {
    const bitmap = new OffscreenCanvas(canvas.width, canvas.height);
    const context = bitmap.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return Array.from(context.getImageData(0, 0, canvas.width, canvas.height).data);
  };
  await new Promise(requestAnimationFrame);
  if (draw) window.eval(draw);
  const canvases = selectors.map((selector) => document.querySelector(selector));
  return Promise.all(canvases.map((canvas) => (canvas.getContext("webgpu") ? window.frameOf(canvas) : read(canvas))));
}, [selectors, draw]);
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
  const [rings] = await pixels(typed, ["canvas"]);
  seen.rings = colors(rings);

  const three = await open("three/index.html#still");
  const [before, after] = await pixels(three, ["#webgl", "#webgpu"], "drawAt(1500)");
  const far = before.filter((value, at) => Math.abs(value - after[at]) > 8).length;
  seen.three = { colors: [colors(before), colors(after)], far: far / before.length };

  const worker = await open("worker/index.html");
  seen.worker = await worker.evaluate(() => document.body.dataset.ready);
  const [ball] = await pixels(worker, ["canvas"]);
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
