// Does the lessons of docs/tutorial.md in Chromium, to the letter. The arguments: the server's address, the browser, the module
// playwright-core. Prints one JSON object of what it saw.

import { valueUnder } from "./pointer.mjs";

const [address, executablePath, module] = process.argv.slice(2);
const { chromium } = await import(module);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1400, height: 1000 } });
const limit = { timeout: 240000 };
page.setDefaultTimeout(limit.timeout);
const seen = { errors: [] };
page.on("pageerror", (error) => seen.errors.push(error.message));
const until = (work, argument) => page.waitForFunction(work, argument, limit);
const textOf = (selector) => page.locator(selector).innerText();
const line = (text) => page.locator("#editor .cm-line", { hasText: text }).first();
const picture = () => page.locator("#pictures img").first().getAttribute("src");
const drawnAnew = (from) => until((from) => document.querySelector("#pictures img")?.getAttribute("src") !== from, from);
try {
  await page.goto(address);
  await page.waitForSelector("#pictures img", limit);

  // A mistake, and light from another side.
  await page.locator("#files button", { hasText: "globe.frag" }).click();
  await line("color = vec4(light * albedo, 1.0);").click();
  await page.keyboard.press("Home");
  for (let at = 0; at < "colo".length; at += 1) await page.keyboard.press("ArrowRight");
  await page.keyboard.type("u");
  await page.waitForSelector("#findings li.error", limit);
  seen.finding = await textOf("#findings li.error");
  await page.getByRole("button", { name: "write `color`" }).first().click();
  await until(() => document.querySelector("#findings-title").textContent === "No findings");
  let before = await picture();
  await page.getByRole("slider", { name: "towardsLight x", exact: true }).focus();
  await page.keyboard.press("Home");
  await drawnAnew(before);
  seen.number = await page.getByLabel("towardsLight x, number", { exact: true }).inputValue();
  seen.dot = (await page.locator("#files button", { hasText: "globe.toml" }).textContent()).includes("•");

  // Where a pixel comes from.
  const globe = page.locator("#pictures img").first();
  await globe.scrollIntoViewIfNeeded();
  const box = await globe.boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 40, box.y + box.height / 2);
  await page.waitForSelector("#stepper:not([hidden])", limit);
  await page.click("#step-last");
  seen.last = await page.textContent("#step-now");
  const wanted = "max(dot(normalize(normal), towardsLight), 0.0)";
  for (let step = 0; step < 50; step += 1) {
    if ((await page.locator("#editor .cm-step").allTextContents()).join("") === wanted) break;
    await page.click("#step-back");
  }
  seen.step = await textOf("#step-now");
  const place = () => page.evaluate(() => {
    const found = [...document.querySelectorAll("#editor .cm-line")].find((one) => one.textContent.includes("light * albedo"));
    const walker = document.createTreeWalker(found, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const at = node.textContent.indexOf("albedo");
      if (at < 0) continue;
      const range = document.createRange();
      range.setStart(node, at + 1);
      range.setEnd(node, at + 3);
      const { left, top, height } = range.getBoundingClientRect();
      return [left, top + height / 2];
    }
    return null;
  });
  seen.value = await valueUnder(page, place);
  before = await picture();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 10, { steps: 4 });
  await page.mouse.up();
  await drawnAnew(before);

  // From GLSL to a GPU's picture.
  const matched = () => page.locator("#translation .cm-match").allTextContents();
  await line("float light").hover();
  await page.waitForSelector("#translation .cm-match", limit);
  seen.matched = { wgsl: await matched() };
  await page.locator("#translation .cm-line", { hasText: "let albedo" }).hover();
  await until(() => document.querySelector("#editor .cm-match")?.textContent.includes("albedo ="));
  seen.matched.glsl = await page.locator("#editor .cm-match").allTextContents();
  await page.check("#leaves-out");
  await until(() => !document.querySelector("#translation .cm-content").textContent.includes("towardsLight"));
  await page.click("#study-needs");
  await page.waitForSelector("#editor .cm-needless", limit);
  seen.crossed = await page.locator("#editor .cm-needless").allTextContents();
  await page.click("#judge");
  await page.waitForSelector("#verdict:not([hidden])", limit);
  seen.verdict = await textOf("#verdict");
  seen.reflection = await textOf("#reflection");
} catch (error) {
  seen.errors.push(String(error));
}
await browser.close();
console.log(JSON.stringify(seen));
