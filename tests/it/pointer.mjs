// Points at places in the page's editor.

// The value that the editor tells of the expression under the pointer. `place` computes where that is in the window. A text that moves
// under a pointer that rests loses its hint, and no event brings it back: so the pointer comes again until there is one.
export const valueUnder = async (page, place) => {
  for (let attempt = 0; attempt < 120; attempt += 1) {
    await page.mouse.move(2, 2);
    const [x, y] = await place();
    await page.mouse.move(x, y, { steps: 3 });
    const told = await page.waitForSelector(".cm-value", { timeout: 2000 }).catch(() => null);
    if (told) return told.textContent();
  }
  throw new Error("the editor tells no value under the pointer");
};
