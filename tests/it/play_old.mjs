// Drives the page of `glisten play` in Chromium where answers are of older texts, or none has come yet: a shader with an error and without a
// scene, a fix after a key, steps, hints, the translation, the verdict, a slow picture; then the focus, a low window, many pages. The
// arguments: the address of a server of a folder, that folder, the address of a server of a shader alone, the browser, the module
// playwright-core. Prints one JSON object of what it saw.

import { existsSync, readFileSync, unlinkSync, writeFileSync } from "node:fs";
const [address, folder, alone, executablePath, module] = process.argv.slice(2);
const { chromium } = await import(module);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const context = await browser.newContext({ viewport: { width: 1300, height: 900 } });
const limit = { timeout: 120000 };
const seen = { errors: [] };
const opened = async (address) => {
  const page = await context.newPage();
  page.setDefaultTimeout(limit.timeout);
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("dialog", (dialog) => dialog.accept());
  page.waits = 0;
  page.on("request", (request) => { if (request.url().includes("/api/changes")) page.waits = 1; });
  await page.goto(address);
  return page;
};
const text = (page) => page.locator("#editor .cm-line").allTextContents().then((lines) => lines.join("\n"));
const error = (page) => page.waitForSelector("#findings li.error", limit);
const typeAt = async (page, place, text) => {
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+Home");
  for (let line = 1; line < place; line += 1) await page.keyboard.press("ArrowDown");
  await page.keyboard.press("End");
  await page.keyboard.insertText(text);
};
const settled = async (page) => {
  await page.waitForFunction(() => !document.querySelector("#findings li.error") && document.querySelector("#pictures img"), null, limit);
  await page.waitForTimeout(500);
};
const pressed = async (page, id) => {
  await page.locator(`#${id}`).focus();
  await page.keyboard.press("Enter");
  await page.waitForTimeout(200);
  return page.evaluate(() => document.activeElement.id);
};
let page = null;
try {
  // A shader alone: its error is shown and mended here, then it gets a scene.
  page = await opened(alone);
  await error(page);
  seen.draft = { findings: await page.locator("#findings li").allTextContents(), files: await page.locator("#files button").allTextContents() };
  await page.locator("#findings li.error button:not(.link)").first().click();
  await page.waitForSelector("#pictures img", limit);
  await page.waitForFunction(() => document.querySelector("#state").textContent.includes("this scene is new"), null, limit);
  seen.draft.made = await page.locator("#files button").allTextContents();
  seen.draft.focus = await pressed(page, "save");
  await page.waitForFunction(() => document.querySelector("#state").textContent === "saved", null, limit);
  await page.close();

  page = await opened(address);
  await settled(page);
  await page.fill("#inspect-x", "8");
  await page.fill("#inspect-y", "8");
  await page.click("#inspect");
  await page.waitForSelector("#stepper:not([hidden])", limit);
  seen.focus = [await pressed(page, "step-last"), await pressed(page, "step-first")];
  await page.locator("#files button", { hasText: "a.frag" }).click();

  // An error: steps, hints and matching of the older text do not mark this one.
  await typeAt(page, 1, "\nfloat k = mixx(0.1, 0.2, 0.3);\n");
  await error(page);
  await page.waitForSelector("#stepper.is-old", limit);
  await page.click("#step-last");
  await page.click("#step-back");
  const place = await page.locator("#editor .cm-line", { hasText: "vec4(shade" }).boundingBox();
  await page.mouse.move(place.x + 100, place.y + place.height / 2, { steps: 3 });
  await page.waitForTimeout(800);
  seen.old = {
    steps: await page.locator("#stepper.is-old").count(), marked: await page.locator("#editor .cm-step").count(), hints: await page.locator(".cm-value").count(),
    matched: await page.locator(".cm-match").count(), kept: await page.locator(".is-kept:visible").count(),
  };
  // A fix after a key, before the answer.
  await page.evaluate(() => { const sent = window.fetch; window.fetch = (path, given) => (path === "/api/ask" ? new Promise(() => {}) : sent(path, given)); });
  await typeAt(page, 1, "\n");
  await page.locator("#findings li.error button:not(.link)").first().click();
  seen.fix = { said: await page.textContent("#state"), line: (await text(page)).split("\n").find((line) => line.startsWith("float k")) };
  await page.reload();
  await settled(page);

  // One request that fails is not the end.
  await page.evaluate(() => { const sent = window.fetch; window.fetch = (path, given) => { if (!path.startsWith("/api/changes")) return sent(path, given); window.fetch = sent; return Promise.reject(new Error("lost")); }; });
  writeFileSync(`${folder}/a.vert`, `${readFileSync(`${folder}/a.vert`, "utf8")}// more\n`);
  await page.waitForTimeout(1500);
  writeFileSync(`${folder}/a.vert`, `${readFileSync(`${folder}/a.vert`, "utf8")}// and more\n`);
  await page.locator("#files button", { hasText: "a.vert" }).click();
  await page.waitForFunction(() => document.querySelector("#editor").textContent.includes("// and more"), null, limit);
  seen.alive = await page.textContent("#state");
  // A text that names a file outside: no findings of another text stay.
  await page.locator("#files button", { hasText: "a.frag" }).click();
  await typeAt(page, 1, "\n#include \"../secret\"\n");
  await error(page);
  await page.locator("#editor .cm-line", { hasText: "secret" }).click();
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.insertText(".frag");
  await page.waitForFunction(() => document.querySelector("#findings-title").textContent === "Not checked", null, limit);
  seen.outside = [await page.textContent("#state"), await page.locator("#findings li").count()];
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await settled(page);

  // Ctrl-S with Caps Lock.
  seen.caps = await page.evaluate(() => !document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "S", ctrlKey: true, bubbles: true, cancelable: true })));
  await page.click("#judge");
  await page.waitForSelector("#verdict:not([hidden])", limit);
  await page.locator("#files button", { hasText: "a.frag" }).click();
  await typeAt(page, 1, "\nfloat k = mixx(0.1, 0.2, 0.3);\n");
  await error(page);
  seen.verdict = await page.locator("#verdict:visible, #says:visible").count();
  await page.keyboard.press("Control+z");
  await settled(page);
  // A picture that takes long says so.
  await typeAt(page, 2, "\nfloat slow() { float s = shade + gl_FragCoord.x; for (int i = 0; i < 300000; ++i) s = sin(s + float(i)); return s; }\n#define shade slow()\n");
  await page.waitForFunction(() => document.querySelector("#drawn").textContent.startsWith("drawing …"), null, limit);
  seen.late = await page.textContent("#drawn");
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.querySelector("#drawn").textContent.includes("by the reference"), null, limit);

  // A low window has room for more than the picture.
  await page.setViewportSize({ width: 1366, height: 625 });
  seen.room = await page.evaluate(() => {
    const results = document.querySelector(".results");
    results.scrollTop = 400;
    return results.getBoundingClientRect().bottom - results.firstElementChild.getBoundingClientRect().bottom;
  });

  // Of many pages, one waits for changes, and all hear of them.
  const pages = [];
  for (let count = 0; count < 8; count += 1) {
    pages.push(await opened(address));
    await pages.at(-1).waitForSelector("#pictures img", limit);
  }
  await page.close();
  await pages[0].waitForTimeout(500);
  unlinkSync(`${folder}/a.toml`);
  for (const page of pages) await error(page);
  seen.gone = { said: await pages[7].textContent("#findings li.error"), links: await pages[7].locator("#findings .link").count() };
  await pages[7].click("#save");
  await settled(pages[7]);
  seen.gone.back = existsSync(`${folder}/a.toml`);
  seen.waits = pages.reduce((sum, page) => sum + page.waits, 0);
} catch (error) {
  seen.errors.push(String(error));
  seen.state = await page?.evaluate(() => ["state", "drawn", "findings", "files"].map((id) => document.getElementById(id)?.textContent)).catch(String);
}
await browser.close();
console.log(JSON.stringify(seen));
