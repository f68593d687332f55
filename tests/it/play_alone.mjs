// Drives a page of `glisten play --export --module` in Chromium, from its file: findings and their fixes, pictures, the camera, the inspector,
// a loop without end, a link, the gallery. The arguments: the page, the browser, the module playwright-core, a folder for screenshots.
// Prints one JSON object of what it saw.

const [exported, executablePath, module, shots] = process.argv.slice(2);
const { chromium } = await import(module);
// SwiftShader draws by WebGPU without a GPU.
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"] });
const seen = { errors: [], asked: [] };
const limit = { timeout: 240000 };
const opened = async (address, viewport = { width: 1300, height: 900 }) => {
  const page = await browser.newPage({ viewport });
  page.setDefaultTimeout(limit.timeout);
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("request", (request) => { if (!/^(data|file|blob):/.test(request.url())) seen.asked.push(request.url()); });
  await page.goto(address);
  return page;
};
const picture = (page) => page.locator("#pictures img").first().getAttribute("src");
const changes = (page, from) => page.waitForFunction((from) => { const now = document.querySelector("#pictures img")?.getAttribute("src"); return now && now !== from; }, from, limit);
const number = (text) => Number(/in (\d+) ms/.exec(text)?.[1]);
try {
  const page = await opened(`file://${exported}`);
  await page.waitForSelector("#pictures img", limit);
  seen.cards = await page.locator("#cards button").count();
  if (shots) await page.screenshot({ path: `${shots}/gallery.png` });
  await page.selectOption("#scenes", "shaders/a.toml");
  await page.waitForFunction(() => document.querySelector("#files")?.textContent.includes("a.frag"), null, limit);
  seen.files = await page.locator("#files button").allTextContents();
  await page.waitForFunction(() => document.querySelector("#translation .cm-content")?.textContent.includes("@fragment"), null, limit);
  seen.reflection = (await page.textContent("#reflection")).includes("shade");
  seen.drawn = await page.textContent("#drawn");
  seen.milliseconds = number(seen.drawn);

  // An error is marked, its fix is applied, and the picture follows.
  await page.locator("#files button", { hasText: "a.frag" }).click();
  let before = await picture(page);
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+End");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("End");
  await page.keyboard.type("\ncolor.r = mixx(color.r, 1.0, 0.5);");
  await page.waitForFunction(() => document.querySelector("#findings li.error button:not(.link)")?.textContent === "write `mix`", null, limit);
  await page.locator("#findings li.error button:not(.link)").first().click();
  await page.waitForFunction(() => !document.querySelector("#findings li.error"), null, limit);
  await changes(page, before);
  seen.fixed = true;

  before = await picture(page);
  await page.getByRole("slider", { name: "shade", exact: true }).focus();
  await page.keyboard.press("End");
  await changes(page, before);
  seen.slider = true;
  before = await picture(page);
  const box = await page.locator("#pictures img").first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, { steps: 4 });
  await page.mouse.up();
  await changes(page, before);
  seen.turned = true;
  await page.mouse.click(x, y);
  await page.waitForSelector("#stepper:not([hidden])", limit);
  seen.inspected = await page.textContent("#inspected");
  if (shots) await page.screenshot({ path: `${shots}/page.png` });

  // The browser draws by WebGPU, and its picture is judged; a fault in its code is found.
  await page.waitForFunction(async () => (await navigator.gpu?.requestAdapter()) === null || !document.querySelector("#judge").hidden, null, limit);
  if (await page.locator("#judge").isVisible()) {
    const verdict = async () => {
      await page.click("#judge");
      await page.waitForFunction(() => document.querySelector("#judge").ariaDisabled !== "true", null, limit);
      return [await page.textContent("#verdict"), await page.textContent("#says"), await page.textContent("#drawn")];
    };
    await page.locator("#by label", { hasText: "GPU" }).click();
    await page.waitForFunction(() => /by WebGPU|Not drawn/.test(document.querySelector("#drawn").textContent), null, limit);
    seen.byGpu = await page.textContent("#drawn");
    seen.verdict = await verdict();
    // A study that is asked for meanwhile ends no verdict.
    await page.click("#judge");
    await page.click("#study-needs");
    await page.waitForSelector("#study table", limit);
    await page.waitForFunction(() => document.querySelector("#judge").ariaDisabled !== "true", null, limit);
    seen.both = await page.locator("#verdict").isVisible();
    if (shots) await page.screenshot({ path: `${shots}/judged.png` });
    await page.evaluate(() => {
      const create = GPUDevice.prototype.createShaderModule;
      window.heal = () => { GPUDevice.prototype.createShaderModule = create; };
      GPUDevice.prototype.createShaderModule = function (given) { return create.call(this, { ...given, code: given.code.replace(/0\.5f?/, "0.52") }); };
    });
    seen.faulty = await verdict();
    await page.evaluate(() => window.heal());
    await page.locator("#by label", { hasText: "reference" }).click();
    await page.waitForFunction(() => /by the reference/.test(document.querySelector("#drawn").textContent), null, limit);
  }

  // A link holds scene and texts.
  before = await picture(page);
  await page.click("#share");
  await page.waitForFunction(() => location.hash.length > 10, null, limit);
  const other = await opened(page.url());
  await other.waitForSelector("#pictures img", limit);
  seen.linked = { same: await picture(other) === before, text: (await other.locator("#files button", { hasText: "a.frag" }).textContent()).includes("•"), scene: await other.inputValue("#scenes") };
  // Neither another link nor another scene takes the texts away unasked, and who keeps them keeps the address.
  const hash = await other.evaluate(() => location.hash);
  seen.asked_first = 0;
  other.on("dialog", (dialog) => { seen.asked_first += 1; dialog.dismiss(); });
  await other.evaluate(() => { location.hash = "#AAAA"; });
  await other.waitForFunction((hash) => location.hash === hash, hash, limit);
  await other.selectOption("#scenes", "shaders/b.toml");
  await other.waitForFunction(() => document.querySelector("#scenes").value === "shaders/a.toml", null, limit);
  seen.kept = (await other.evaluate(() => location.hash)) === hash && (await other.locator("#files button", { hasText: "a.frag" }).textContent()).includes("•");
  const bad = await opened(`file://${exported}#AAAA`);
  await bad.waitForFunction(() => document.querySelector("#state").textContent.includes("the link cannot be opened"), null, limit);
  seen.badLink = await bad.textContent("#state");
  await bad.close();
  await other.close();

  // What never ends is ended: by the reference's limit or by the page.
  await page.locator("#files button", { hasText: "a.frag" }).click();
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+A");
  await page.keyboard.insertText("#version 150\nuniform float shade;\nout vec4 color;\nvoid main() {\n    float sum = shade;\n    for (;;) { sum += 0.5; if (sum < -1.0) break; }\n    color = vec4(sum);\n}\n");
  await page.waitForFunction(() => document.querySelector("#drawn").textContent.startsWith("Not drawn"), null, limit);
  seen.endless = await page.textContent("#drawn");
  await page.keyboard.press("Control+A");
  await page.keyboard.insertText("#version 150\nuniform float shade;\nout vec4 color;\nvoid main() { color = vec4(0.0, shade, 0.0, 1.0); }\n");
  await page.waitForFunction(() => /by the reference/.test(document.querySelector("#drawn").textContent), null, limit);
  seen.alive = true;

  const narrow = await opened(`file://${exported}`, { width: 360, height: 740 });
  await narrow.waitForSelector("#pictures img", limit);
  seen.width = await narrow.evaluate(() => document.documentElement.scrollWidth);
  if (shots) await narrow.screenshot({ path: `${shots}/narrow.png` });
} catch (error) {
  seen.errors.push(String(error));
}
await browser.close();
console.log(JSON.stringify(seen));
