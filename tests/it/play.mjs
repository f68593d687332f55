// Drives the page of `glisten play` in Chromium: an error and its fix, a slider, the camera, a pixel, the verdict, saving, a narrow
// window, the page as a file. The arguments: the server's address, an exported page, the browser, the module playwright-core.
// Prints one JSON object of what it saw.

import { valueUnder } from "./pointer.mjs";

const [address, exported, executablePath, module] = process.argv.slice(2);
const { chromium } = await import(module);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1300, height: 900 } });
const seen = { errors: [] };
const listen = (page) => {
  page.setDefaultTimeout(limit.timeout);
  page.on("pageerror", (error) => seen.errors.push(error.message));
};
// A machine that runs other tests beside this one is slow.
const limit = { timeout: 240000 };
const until = (work, argument) => page.waitForFunction(work, argument, limit);
const picture = () => page.locator("#pictures img").first().getAttribute("src");
const changes = (from) => until((from) => document.querySelector("#pictures img")?.getAttribute("src") !== from, from);
listen(page);
try {
  await page.goto(address);
  await page.waitForSelector("#pictures img", limit);
  seen.files = await page.locator("#files button").allTextContents();
  seen.wgsl = (await page.locator("#translation .cm-content").textContent()).includes("@fragment");
  seen.reflection = (await page.textContent("#reflection")).includes("shade");

  await page.locator("#files button", { hasText: "a.frag" }).click();
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+End");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("End");
  await page.keyboard.type("\ncolor.r = mixx(color.r, 1.0, 0.5);");
  // Answers to a part of the line offer no fix any more.
  await until(() => document.querySelectorAll("#findings li.error").length === 1 && document.querySelector("#findings li.error button:not(.link)")?.textContent === "write `mix`");
  seen.finding = await page.textContent("#findings li.error");
  seen.mark = (await page.locator("#editor .cm-lintRange-error").count()) > 0;
  let before = await picture();
  await page.locator("#findings li.error button:not(.link)").first().click();
  await until(() => !document.querySelector("#findings li.error"));
  await changes(before);
  seen.fixed = true;

  before = await picture();
  await page.getByRole("slider", { name: "shade", exact: true }).focus();
  await page.keyboard.press("End");
  await changes(before);
  await page.locator("#files button", { hasText: "a.toml" }).click();
  seen.slider = (await page.locator("#editor .cm-content").textContent()).includes("shade = 1.0");

  before = await picture();
  const box = await page.locator("#pictures img").first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await until(() => /reference: \d/.test(document.querySelector("#pixel").textContent));
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, { steps: 4 });
  await page.mouse.up();
  await changes(before);
  seen.turned = true;

  // A click inspects, a drag does not.
  seen.drag = await page.locator("#stepper").isVisible();
  await page.mouse.click(x, y);
  await page.waitForSelector("#stepper:not([hidden])", limit);
  seen.inspected = await page.textContent("#inspected");
  const stepOf = () => page.textContent("#step-now");
  await page.click("#step-last");
  seen.last = await stepOf();
  await page.click("#step-back");
  seen.back = await stepOf();
  seen.emphasis = await page.locator("#editor .cm-step").first().textContent();
  // The value of an expression under the pointer.
  seen.value = await valueUnder(page, async () => {
    const step = await page.locator("#editor .cm-step").first().boundingBox();
    return [step.x + step.width / 2, step.y + step.height / 2];
  });
  await page.mouse.move(2, 2);

  // What the picture does not need is crossed out, until the texts change.
  await page.click("#study-needs");
  await page.waitForSelector("#study .found li", limit);
  await page.locator("#study .found button.link", { hasText: "a.frag" }).first().click();
  await page.waitForSelector("#editor .cm-needless", limit);
  seen.needs = { crossed: await page.locator("#editor .cm-needless").first().textContent(), file: await page.locator("#study .found button.link", { hasText: "a.frag" }).first().textContent() };
  await page.getByRole("slider", { name: "shade", exact: true }).focus();
  await page.keyboard.press("ArrowLeft");
  await page.waitForSelector("#study.is-old", limit);
  seen.needs.old = (await page.locator("#editor .cm-needless").count()) === 0;
  await page.keyboard.press("End");
  await page.click("#study-stability");
  await page.waitForSelector("#study-verdict:not([hidden])", limit);
  seen.stability = { verdict: await page.textContent("#study-verdict"), map: await page.locator("#study .map img").count() };

  await page.click("#judge");
  await page.waitForSelector("#verdict:not([hidden])", limit);
  seen.verdict = await page.textContent("#verdict");
  seen.pictures = await page.locator("#pictures img").count();
  // Who keeps unsaved changes keeps the scene, and the list says so.
  const chosen = await page.inputValue("#scenes");
  const scenes = await page.locator("#scenes optgroup[label=Scenes] option").evaluateAll((options) => options.map((option) => option.value));
  page.once("dialog", (dialog) => dialog.dismiss());
  await page.selectOption("#scenes", scenes.find((scene) => scene !== chosen));
  seen.kept = (await page.inputValue("#scenes")) === chosen;
  await page.click("#save");
  await until(() => document.querySelector("#state").textContent === "saved");
  await page.setViewportSize({ width: 360, height: 740 });
  seen.width = await page.evaluate(() => document.documentElement.scrollWidth);

  const file = await browser.newPage({ viewport: { width: 1300, height: 900 } });
  listen(file);
  const asked = [];
  file.on("request", (request) => asked.push(request.url()));
  await file.goto(`file://${exported}`);
  await file.waitForSelector("#pictures img", limit);
  await file.selectOption("#target", "msl");
  await file.click("#study-needs");
  await file.waitForSelector("#study table", limit);
  const needless = await file.locator("#study .found li").count();
  await file.click("#study-stability");
  await file.waitForSelector("#study-verdict:not([hidden])", limit);
  const stable = await file.textContent("#study-verdict");
  seen.exported = { needless, stable, msl: (await file.locator("#translation .cm-content").textContent()).includes("metal_stdlib"), asked: asked.filter((url) => !url.startsWith("data:") && !url.startsWith("file:")) };
} catch (error) {
  seen.errors.push(String(error));
  seen.state = await page.evaluate(() => ["state", "drawn", "pixel"].map((id) => document.getElementById(id)?.textContent)).catch(String);
}
await browser.close();
console.log(JSON.stringify(seen));
