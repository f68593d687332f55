// Drives the page of `glisten play` in Chromium where texts are at stake: line endings, bytes, numbers, places that move, two pages, files that
// change on disk, and the end of the server. The arguments: the server's address, its folder, its process, the browser, the module playwright-core.
// Prints one JSON object of what it saw.

import { readFileSync, writeFileSync, renameSync } from "node:fs";
const [address, folder, server, executablePath, module] = process.argv.slice(2);
const { chromium } = await import(module);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const limit = { timeout: 60000 };
const seen = { errors: [] };
const onDisk = (name) => readFileSync(`${folder}/${name}`, "latin1");
const opened = async () => {
  const page = await browser.newPage({ viewport: { width: 1300, height: 900 } });
  page.setDefaultTimeout(limit.timeout);
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.dialogs = [];
  page.on("dialog", (dialog) => { page.dialogs.push(dialog.type()); dialog.accept(); });
  await page.goto(address);
  await page.waitForSelector("#pictures img", limit);
  return page;
};
const page = await opened();
const on = (page) => ({
  until: (work, argument) => page.waitForFunction(work, argument, limit),
  text: () => page.locator("#editor .cm-line").allTextContents().then((lines) => lines.join("\n")),
  file: (name) => page.locator("#files button", { hasText: name }).first().click(),
  state: (text) => page.waitForFunction((text) => document.querySelector("#state").textContent.includes(text), text, limit),
  focus: () => page.evaluate(() => document.activeElement.dataset.key ?? document.activeElement.tagName),
  scene: async (name) => {
    await page.selectOption("#scenes", `shaders/${name}.toml`);
    await page.waitForFunction((name) => document.querySelector("#files").textContent.includes(`${name}.vert`) || document.querySelector("#findings li.error"), name, limit);
  },
});
const { until, text, file, state, focus, scene } = on(page);
const line = async (start) => (await text()).split("\n").find((line) => line.startsWith(start));
const lineIs = (wanted) => until((wanted) => [...document.querySelectorAll("#editor .cm-line")].some((line) => line.textContent === wanted), wanted);
const editor = () => page.locator("#editor .cm-content");
const slider = () => page.getByRole("slider", { name: "shade", exact: true });
try {
  // A broken scene has no picture of another one.
  await scene("crlf");
  await until(() => document.querySelector("#drawn").textContent.startsWith("Not drawn"));
  seen.foreign = { drawn: await page.textContent("#drawn"), pictures: await page.locator("#pictures img").count(), state: await page.textContent("#state") };
  await file("crlf.frag");
  await page.locator("#findings li.error button:not(.link)").first().click();
  await page.waitForSelector("#pictures img", limit);
  await file("crlf.toml");
  await slider().focus();
  await page.keyboard.press("End");
  await lineIs("shade = 1.0");
  await page.click("#save");
  await state("saved");
  // The watcher has told of it by then.
  await page.waitForTimeout(1500);
  seen.crlf = { said: await page.textContent("#state"), frag: onDisk("crlf.frag"), toml: onDisk("crlf.toml") };

  await scene("latin");
  await file("latin.frag");
  seen.latin = { title: await page.locator("#files button", { hasText: "latin.frag" }).getAttribute("title"), fixed: await page.locator("#files .is-fixed").count() };
  await editor().click();
  await page.keyboard.type("x");
  seen.latin.typed = (await text()).startsWith("#version");

  // What is typed is what is written.
  await scene("a");
  await file("a.toml");
  const box = page.getByRole("spinbutton", { name: "shade, number", exact: true });
  seen.numbers = [];
  for (const number of ["1e30", "0.00002", "1e-7", "0.123456789", "5", "-.5"]) {
    const before = await line("shade");
    await box.fill(number);
    await box.press("Enter");
    await until((before) => [...document.querySelectorAll("#editor .cm-line")].some((line) => line.textContent.startsWith("shade") && line.textContent !== before), before);
    seen.numbers.push((await line("shade")).replace("shade = ", ""));
  }
  await box.fill("0.25");
  await box.press("Enter");
  await lineIs("shade = 0.25");

  // A control that is used before the page has read a typed change.
  await editor().click();
  await page.keyboard.press("Control+Home");
  await page.evaluate(() => { window.sent = window.fetch; window.fetch = (path, given) => (path === "/api/ask" ? new Promise(() => {}) : window.sent(path, given)); });
  await page.keyboard.insertText("# a comment of some length\n");
  await slider().evaluate((slider) => { slider.value = 0.75; slider.dispatchEvent(new Event("input")); });
  seen.moved = { first: (await text()).split("\n")[0], shade: await line("shade") };
  // The number itself is typed over: nobody knows its place until the scene is read again.
  await page.locator("#editor .cm-line", { hasText: "shade =" }).click();
  await page.keyboard.press("End");
  await page.keyboard.insertText("5");
  await slider().evaluate((slider) => { slider.value = 0.5; slider.dispatchEvent(new Event("input")); });
  seen.moved.typed = await line("shade");
  await page.reload();
  seen.reload = page.dialogs.splice(0);
  await page.waitForSelector("#pictures img", limit);

  // Enter on a file, a step: the focus stays. The list of steps is one stop, which arrows go through.
  await scene("a");
  await page.locator("#files button").first().focus();
  await page.keyboard.press("Enter");
  await page.waitForTimeout(300);
  seen.focus = { file: await focus() };
  await page.fill("#inspect-x", "8");
  await page.fill("#inspect-y", "8");
  await page.click("#inspect");
  await page.waitForSelector("#stepper:not([hidden])", limit);
  await page.locator("#step-list button").nth(2).focus();
  await page.keyboard.press("Enter");
  seen.focus.step = await focus();
  await page.keyboard.press("ArrowDown");
  seen.focus.arrow = await focus();
  await page.keyboard.press("End");
  seen.focus.end = Number(await focus()) === Number(await page.getAttribute("#step", "max"));
  seen.stops = await page.locator("#step-list button:not([tabindex='-1'])").count();
  seen.named = await page.getByRole("button", { name: "One step back", exact: true }).count();
  await page.fill("#inspect-x", "1e300");
  await page.click("#inspect");
  seen.outside = { said: await page.textContent("#inspected"), old: await page.locator("#stepper.is-old").count() };
  await page.fill("#inspect-x", "8");
  await page.click("#inspect");
  await page.waitForSelector("#stepper:not(.is-old)", limit);
  await file("a.frag");
  await editor().click();
  await page.keyboard.press("Control+End");
  await page.keyboard.insertText("xyz");
  await page.waitForSelector("#stepper.is-old", limit);
  await page.keyboard.press("Control+z");
  await page.waitForSelector("#stepper:not(.is-old)", limit);

  // A conflict stays until it is solved, in either way.
  const conflict = async (ours, theirs, button) => {
    await page.keyboard.press("Control+End");
    await page.keyboard.insertText(ours);
    writeFileSync(`${folder}/a.frag`, onDisk("a.frag") + theirs);
    await page.keyboard.press("Control+s");
    await page.waitForSelector("#conflict:not([hidden])", limit);
    await page.waitForTimeout(1000);
    const said = await page.textContent("#conflict");
    await page.locator("#conflict button").first().focus();
    await page.getByRole("button", { name: button, exact: true }).click();
    await until(() => document.querySelector("#conflict").hidden && document.querySelector("#save").ariaDisabled === "true");
    seen.refocused = await page.evaluate(() => document.activeElement.classList.contains("cm-content"));
    return said;
  };
  seen.conflict = await conflict("// ours\n", "// theirs\n", "Overwrite it with this one");
  seen.overwritten = onDisk("a.frag").endsWith("}\n// ours\n");
  await editor().click();
  await conflict("// more\n", "// theirs\n", "Take the text on disk");
  seen.taken = (await text()).includes("// theirs") && !(await text()).includes("// more") && onDisk("a.frag").endsWith("// ours\n// theirs\n");

  // New scenes: by any name of a stage, with a free name of their own, and asked about when the page goes.
  const programs = await page.locator("#scenes optgroup[label='New scene for'] option").allTextContents();
  seen.programs = programs.filter((name) => name.includes("lens"));
  await page.selectOption("#scenes", { label: "shaders/cfg.frag, shaders/cfg.vert" });
  await state("this scene is new");
  seen.made = await page.inputValue("#scenes");
  await page.locator("#files button", { hasText: "cfg-scene.toml" }).click();
  await editor().click();
  await page.keyboard.insertText("# mine\n");
  await page.reload();
  seen.lost = page.dialogs.splice(0);
  await page.waitForSelector("#pictures img", limit);

  // Another page of the server, with another scene: pixels are those of each, and both follow the disk.
  await scene("a");
  const other = await opened();
  const others = on(other);
  await others.scene("b");
  await other.waitForSelector("#pictures img", limit);
  const pixel = async (page) => {
    const box = await page.locator("#pictures img").first().boundingBox();
    await page.mouse.move(box.x + 20, box.y + 20);
    await page.waitForFunction(() => /reference: \d/.test(document.querySelector("#pixel").textContent), null, limit);
    return (await page.textContent("#pixel")).split("reference: ")[1].split(" ")[0];
  };
  seen.pixels = [await pixel(page), await pixel(other)];
  seen.followed = 0;
  for (let round = 1; round <= 4; round += 1) {
    const before = await Promise.all([page, other].map((one) => one.locator("#pictures img").first().getAttribute("src")));
    for (const name of ["a", "b"]) writeFileSync(`${folder}/${name}.frag`, onDisk(`${name}.frag`).replace(/1\.0, 1\.0\)|0\.\d, 1\.0\)/, `0.${round}, 1.0)`));
    await Promise.all([page, other].map((one, index) => one.waitForFunction((src) => document.querySelector("#pictures img")?.getAttribute("src") !== src, before[index], limit)));
    seen.followed += 1;
  }
  // The list of scenes follows, too, and names the one that is shown.
  renameSync(`${folder}/b.toml`, `${folder}/c.toml`);
  await others.until(() => [...document.querySelector("#scenes").options].some((option) => option.value.endsWith("c.toml")));
  seen.listed = await other.locator("#scenes option").evaluateAll((options) => options.map((option) => option.value)).then((names) => names.some((name) => name.endsWith("/b.toml")));
  await other.close();

  // The last words of the page stay.
  process.kill(Number(server), "SIGINT");
  await state("has ended");
  await file("a.frag");
  await editor().click();
  await page.keyboard.insertText("// late\n");
  await page.keyboard.press("Control+s");
  await page.waitForTimeout(700);
  seen.ended = await page.textContent("#state");
} catch (error) {
  seen.errors.push(String(error));
  seen.state = await page.evaluate(() => ["state", "drawn", "pixel", "conflict"].map((id) => document.getElementById(id)?.textContent)).catch(String);
}
await browser.close();
console.log(JSON.stringify(seen));
