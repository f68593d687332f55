
// ---- The page of `glisten play`: it holds the texts, asks for everything else, and shows the answers.
const start = JSON.parse(byId("start").textContent);
const isServed = start.mode === "server";
const isLive = isServed || start.mode === "module";
const KINDS = { toml: "toml" };
const kindOf = (name) => KINDS[name.split(".").at(-1)] ?? "glsl";
// name -> { text, saved, raw, made, isWritable, fixed }: the text in the editor's form, the same of the file (null if there is none), the file
// as it is, the text of a new file as it was made, and why nobody can change it.
const docs = new Map();
let scene = null;       // the name of the scene file
let shown = null;       // the name of the text in the editor
let findings = [];
let controls = [];
let programs = [];
let programsFor = 0;    // the edition that they are for: with errors, the last ones stay
let stage = null;
let translated = null;  // the stage in the translation
let names = [];         // of the files, by the numbers that translations give them
let isJudged = false;
let isJudging = false;
let pictured = null;    // the scene of the picture
let isCoarse = false;   // whether the picture is a first look
let edition = 0;        // counts the changes of texts: an answer to an older one has places that are no longer true
let foundFor = 0;       // the edition that the findings and the programs are for

// Says something. Who said it, `by`, takes it back; the last words of a page without a server stay.
const said = { by: null, isLast: false };
const say = (text, isBad = false, by = "person") => {
  if (said.isLast) return;
  byId("state").textContent = text;
  byId("state").classList.toggle("bad", isBad);
  said.by = by;
};
const unsay = (...who) => { if (who.includes(said.by)) say("", false, null); };
const ENDED = "`glisten play` has ended; start it again and open its new address";
const sayLast = () => { say(ENDED, true); said.isLast = true; };
const isChanged = (doc) => doc.text !== doc.saved;
const isUnsaved = (doc) => doc.isWritable && (isChanged(doc) || doc.isGone);
// What a person would lose.
const isEdited = (doc) => doc.text !== (doc.saved ?? doc.made);
// Whether a button does anything. It keeps the focus: who pressed it is where they were.
const enable = (id, isOn) => byId(id).setAttribute("aria-disabled", String(!isOn));
addEventListener("click", (event) => { if (event.target.closest?.("button[aria-disabled=true]")) event.stopImmediatePropagation(); }, { capture: true });
// Puts children into an element. If the focus was in it, it is in their place again.
const swap = (parent, ...children) => {
  const key = parent.contains(document.activeElement) ? document.activeElement.dataset.key : undefined;
  parent.replaceChildren(...children.flat());
  if (key !== undefined) parent.querySelector(`[data-key="${CSS.escape(key)}"]`)?.focus({ preventScroll: true });
};

// ---- Questions.
// This page among those of a server, whose questions end none of the others.
const page = Array.from(crypto.getRandomValues(new Uint32Array(4)), (part) => part.toString(16)).join("");
const request = async (method, path, body) => {
  try {
    const response = await fetch(path, { method, headers: { "X-Glisten-Token": start.token }, body: body === undefined ? undefined : JSON.stringify(body) });
    const answer = await response.json();
    return { status: response.status, ...answer };
  } catch {
    return { status: 0, error: ENDED };
  }
};
const changedTexts = () => Object.fromEntries([...docs].filter(([, doc]) => isChanged(doc)).map(([name, doc]) => [name, doc.text]));
const computing = start.mode === "module" ? makeModule(start) : null;
const askAny = computing?.ask ?? ((job) => request("POST", "/api/ask", { page, ...job }));
const ask = (job) => askAny({ scene, texts: changedTexts(), ...job });

// Runs a question so that at most one is under way and the newest always runs; `patience` is how long (ms) a running one may take
// when a newer one waits, unless its turn yields. The server ends the older one.
const latest = (work, patience) => {
  let running = 0, waiting = false, begun = 0, limit = patience, timer = null, newest = 0;
  const run = async () => {
    running += 1; begun = performance.now(); limit = patience; waiting = false;
    const own = newest += 1;
    const isOld = () => waiting || own !== newest;
    // Something else has ended the question: it is asked again.
    const again = () => { if (!isOld()) setTimeout(() => { if (!isOld()) ask(); }, 100); };
    try { await work({ isOld, again, yields: () => { if (!isOld()) limit = 0; } }); } catch (error) { say(`no answer: ${error.message}`, true); }
    running -= 1;
    if (waiting && running === 0) run();
  };
  // The time of the one that runs now, not of one before it.
  const check = () => {
    timer = null;
    if (!waiting || running === 0) return;
    const left = limit - (performance.now() - begun);
    if (left <= 0) run();
    else timer = setTimeout(check, left);
  };
  const ask = () => {
    if (running === 0) { run(); return; }
    waiting = true;
    if (timer === null || limit === 0) { clearTimeout(timer); check(); }
  };
  ask.forget = () => { waiting = false; };
  return ask;
};

// Does what can wait until the next frame is on the screen: the newest of its kind.
const afterNextFrame = () => {
  let newest = null;
  const now = () => { const work = newest; newest = null; work?.(); };
  return (work) => {
    const isFirst = newest === null;
    newest = work;
    // A page that nobody sees has no frames.
    if (document.hidden) now();
    else if (isFirst) requestAnimationFrame(() => setTimeout(now));
  };
};

// ---- The editor and the files.
const [afterKey, afterMove, afterLook] = [afterNextFrame(), afterNextFrame(), afterNextFrame()];
const editor = Editor.create({
  parent: byId("editor"), label: "Source", words: start.words, readOnly: !isLive,
  valueAt: (name, line, column) => inspector.valueAt(name.replace(FIXED, ""), line, column),
  moved: (line, isPerson) => afterMove(() => matching.movedInSource(line, isPerson)),
  pointed: (line) => matching.pointedInSource(line),
  changed: (name, text) => {
    const doc = docs.get(name);
    if (!doc) return;
    setText(name, doc, text);
    textChanged();
  },
});
// Another text of a file. The places of controls move with it; a control moves them itself.
const setText = (name, doc, text) => {
  if (name === scene && !isMoving) {
    const moved = moving(doc.text, text);
    for (const control of controls) control.places = control.places.map(moved);
  }
  doc.text = text;
};
// While a control moves, the picture follows, and all that is read of the texts comes when it rests. Of a key, the findings come first.
let isMoving = false, rests = null;
const textChanged = () => {
  edition += 1;
  if (isJudged) hideVerdict();
  isJudged = isJudging = false;
  unsay("saved", "new", "person");
  clearTimeout(rests);
  if (isMoving) {
    rests = setTimeout(() => { look(); inspector.refresh(); }, 200);
    showFiles(); draw(); studies.age();
    return;
  }
  look();
  // A question about a pixel does not end the picture that was asked for before it.
  afterKey(() => { showFiles(); draw(); studies.age(); inspector.refresh(); });
};
const translation = Editor.create({
  parent: byId("translation"), label: "Translation", words: start.words, readOnly: true,
  moved: (line, isPerson) => matching.movedInTranslation(line, isPerson),
  pointed: (line) => matching.pointedInTranslation(line),
});
const matching = makeMatching({ editor, translation, shown: () => shown, stage: () => (programsFor === edition ? translated : null), files: () => names, open: (name) => open(name) });

// The editor keeps a state for each name, and with it whether its text can be changed: that is a part of the name.
const FIXED = "\0";
const open = (name, line, column) => {
  const doc = docs.get(name);
  if (!doc) return;
  shown = name;
  const isFixed = !isLive || !doc.isWritable;
  editor.show(isFixed ? name + FIXED : name, doc.text, kindOf(name), isFixed);
  showFiles(); mark();
  if (line) editor.go(line, column);
};
const ofFile = (name) => findings.filter((finding) => finding.file === name);
const mark = () => {
  if (!shown) return;
  editor.mark(ofFile(shown), apply);
  editor.cross(studies.linesOf(shown));
};

let filesShown = null;
const showFiles = () => {
  const base = (name) => name.split(/[\\/]/).at(-1);
  // While a number changes, the list does not.
  const now = JSON.stringify([shown, [...docs].map(([name, doc]) => [name, doc.isWritable, isChanged(doc), doc.isGone, ofFile(name).map((one) => one.severity)])]);
  if (now === filesShown) return;
  filesShown = now;
  const bases = [...docs.keys()].map(base);
  swap(byId("files"), [...docs].map(([name, doc]) => {
    const found = ofFile(name);
    const worst = found.some((one) => one.severity === "error") ? "is-bad" : found.length ? "is-fair" : "";
    const label = bases.filter((other) => other === base(name)).length > 1 ? name : base(name);
    return html("button", { "data-key": name, "aria-pressed": String(name === shown), title: doc.isWritable || !isLive ? name : `${name} (cannot be changed here${doc.fixed ? `: ${doc.fixed}` : ""})`, class: `${worst}${doc.isWritable || !isLive ? "" : " is-fixed"}`, click: () => open(name) },
      label + (isChanged(doc) || doc.isGone ? " •" : ""), found.length ? html("span", { class: "count" }, String(found.length)) : null);
  }));
  const changed = [...docs.values()].filter(isUnsaved);
  enable("save", changed.length > 0);
  const verb = isServed ? "Save" : "Download";
  byId("save").textContent = changed.length > 1 ? `${verb} ${changed.length} files` : verb;
};

// Applies the edits of a fix, which are in characters from 1, to all its files. Another text has other places.
const apply = (fix) => {
  if (foundFor !== edition) { say("the text changed meanwhile: press the fix again"); return; }
  const offset = (text, { line, column }) => {
    const lines = text.split("\n");
    const before = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    return before + Array.from(lines[line - 1] ?? "").slice(0, column - 1).join("").length;
  };
  for (const name of new Set(fix.edits.map((edit) => edit.file))) {
    const doc = docs.get(name);
    if (!doc?.isWritable) continue;
    const changes = fix.edits.filter((edit) => edit.file === name)
      .map((edit) => ({ from: offset(doc.text, edit.start), to: offset(doc.text, edit.end), text: edit.text }))
      .sort((a, b) => a.from - b.from);
    rewrite(name, changes);
  }
  // The button of the fix is gone.
  editor.focus();
};

// Rewrites places of a text, in ascending order, whether the editor shows it or not.
const rewrite = (name, changes) => {
  const doc = docs.get(name);
  if (name === shown) { editor.rewrite(changes); return; }
  let text = "", at = 0;
  for (const { from, to, text: by } of changes) { text += doc.text.slice(at, from) + by; at = to; }
  setText(name, doc, text + doc.text.slice(at));
  textChanged();
};

const showFindings = (none = "No findings") => {
  const item = (finding, index) => html("li", { class: finding.severity },
    finding.file ? html("button", { class: "link", "data-key": `at ${index}`, click: () => open(finding.file, finding.line, finding.column) }, `${finding.file.split(/[\\/]/).at(-1)}:${finding.line}:${finding.column}`) : null,
    ` ${finding.severity} ${finding.code}: ${finding.message}`,
    finding.help ? html("div", { class: "help" }, `help: ${finding.help}`) : null,
    isLive && finding.fixes.length ? html("div", {}, finding.fixes.map((fix, at) => html("button", { "data-key": `fix ${index} ${at}`, click: () => apply(fix), title: fix.applicability === "safe" ? "The picture stays the same" : "The picture may change" }, fix.title))) : null);
  swap(byId("findings"), findings.map(item));
  byId("findings-title").textContent = findings.length ? `Findings (${findings.length})` : none;
};

// ---- Looking: findings, controls, translations.
const target = () => byId("target").value;
// The state of a file as it was read.
const asRead = (raw) => ({ text: plain(raw), saved: plain(raw), raw });
const follow = (name, doc, raw) => {
  setText(name, doc, plain(raw));
  Object.assign(doc, asRead(raw));
  if (name === shown) editor.set(doc.text);
};
const take = (answer, asked = edition) => {
  const last = shown, isOutdated = asked !== edition;
  foundFor = asked;
  for (const file of answer.files) {
    const doc = docs.get(file.name);
    const kind = { isWritable: file.is_writable ?? false, fixed: file.fixed };
    if (!doc) docs.set(file.name, { ...asRead(file.text), ...kind });
    else {
      if (doc.isWritable !== kind.isWritable && file.name === shown) shown = null;
      Object.assign(doc, kind);
      // A text that nobody changed here follows the file.
      if (!isOutdated && !isChanged(doc) && doc.raw !== file.text) follow(file.name, doc, file.text);
    }
  }
  names = answer.files.map((file) => file.name);
  const read = new Set(answer.files.map((file) => file.name));
  for (const [name, doc] of docs) if (!read.has(name) && name !== scene && !isChanged(doc)) docs.delete(name);
  // A scene that is gone can be written again.
  if (docs.has(scene)) docs.get(scene).isGone = !read.has(scene);
  findings = isOutdated ? answer.findings.map((finding) => ({ ...finding, fixes: [] })) : answer.findings;
  // What a draft lacks is not a person's business.
  if (draft && !isEdited(docs.get(scene))) findings = findings.filter((finding) => finding.file !== scene);
  if (!shown && docs.has(last)) open(last);
  if (!shown || !docs.has(shown)) open(answer.files.find((file) => kindOf(file.name) === "glsl" && file.name.includes("frag"))?.name ?? answer.files.at(-1)?.name ?? scene);
  const isKept = !answer.programs.length && findings.some((finding) => finding.severity === "error");
  if (!isKept) { programs = answer.programs; programsFor = asked; }
  all(".is-kept").forEach((one) => { one.hidden = !isKept || !programs.length; });
  showFiles(); mark(); showFindings();
  const taken = edition;
  afterLook(() => {
    showTranslation(); showReflection();
    // Controls have places in the texts, which may have changed since.
    if (!isOutdated && taken === edition) takeControls(answer.controls, answer.files.find((file) => file.name === scene)?.text ?? "");
  });
};
// Tells how many errors there are, behind what was said of a file.
const sayErrors = () => {
  const errors = findings.filter((one) => one.severity === "error").length;
  const text = errors ? `${errors} error${errors > 1 ? "s" : ""}${pictured === scene ? ": the picture is the last one that could be drawn" : ""}` : "";
  if (said.by === "saved") say(["saved", text].filter(Boolean).join("; "), false, "saved");
  else if (text) say(text, false, "look");
  else unsay("look");
};
const look = isLive ? latest(async ({ again }) => {
  const asked = edition, of = scene;
  if (!of) return;
  const answer = await ask({ ask: "look", target: target(), leaves_out: byId("leaves-out").checked });
  if (of !== scene) return;
  if (answer.ok) { take(answer.ok, asked); sayErrors(); finish(); }
  else if (answer.status === 409) again();
  else {
    say(answer.error, true, "look");
    // Those that are known are of another text.
    if (answer.status !== 0 && asked === edition) { findings = []; mark(); showFiles(); showFindings("Not checked"); }
  }
}, 400) : () => {};

const showTranslation = () => {
  const stages = programs.flatMap((program, index) => program.stages.map((one) => ({ ...one, key: `${index} ${one.stage}`, label: programs.length > 1 ? `${program.name} ${one.stage}` : one.stage })));
  if (!stages.some((one) => one.key === stage)) stage = stages.find((one) => one.stage === "fragment")?.key ?? stages[0]?.key ?? null;
  swap(byId("stages"), stages.map((one) => html("label", {}, html("input", { "data-key": one.key, type: "radio", name: "stage", value: one.key, checked: one.key === stage, change: () => { stage = one.key; showTranslation(); } }), one.label)));
  const now = stages.find((one) => one.key === stage);
  const text = now ? now.text ?? now.error ?? "" : "";
  translated = now ?? null;
  translation.show(`translation.${target()}`, text, target() === "wgsl" ? "wgsl" : "glsl");
  matching.refresh();
};
const showReflection = () => {
  const row = (cells, tag = "td") => html("tr", {}, cells.map((cell) => html(tag, {}, cell)));
  const placeOf = ({ group, binding }) => `group ${group}, binding ${binding}`;
  const typed = (one) => (one.array_size ? `${one.type}[${one.array_size}]` : one.type);
  const block = (one, name) => ["block", name, `${one.size} bytes`, placeOf(one)];
  const uniform = (one) => ["uniform", one.name, typed(one), `offset ${one.offset}${one.block ? ` in ${one.block}` : ""}`];
  const member = (of) => (one) => (one.members?.length ? one.members.map(member(`${of}.${one.name}`)).flat(1) : [["uniform", `${of}.${one.name}`, typed(one), `offset ${one.offset} in the element`]]);
  const rows = programs.flatMap(({ reflection: told = {} }) => [
    ...(told.attributes ?? []).map((one) => ["attribute", one.name, one.type, `location ${one.location}`]),
    ...(told.loose_block ? [block(told.loose_block, "(uniforms without a block)")] : []),
    ...(told.blocks ?? []).map((one) => block(one, one.name)),
    ...(told.uniforms ?? []).map(uniform),
    ...(told.struct_arrays ?? []).flatMap((one) => [["uniform", `${one.name}[${one.array_size}]`, "structs", `offset ${one.offset ?? 0}, stride ${one.array_stride}`], ...one.members.flatMap(member(`${one.name}[i]`))]),
    ...(told.samplers ?? []).map((one) => ["texture", one.name, one.type, [placeOf(one.texture), one.sampler && `sampler: ${placeOf(one.sampler)}`].filter(Boolean).join("; ")]),
    ...(told.outputs ?? []).map((one) => ["output", one.name, one.type, `location ${one.location}`]),
  ]);
  byId("reflection").replaceChildren(html("table", {}, html("thead", {}, row(["kind", "name", "type", "place"], "th")), html("tbody", {}, rows.map((cells) => row(cells)))));
};

// ---- Controls: they rewrite numbers of the scene's text.
// Sets the values of a control; `typed` has the texts of those that a person typed. A place that a change has touched, or whose text is not
// the one that was read, is left alone until the scene has been read again.
const setControl = (control, values, typed = []) => {
  const text = docs.get(scene)?.text ?? "";
  const changes = [];
  const isKnown = (index) => control.places[index] && text.slice(...control.places[index]) === control.texts[index];
  values.forEach((value, index) => {
    if (value === control.values[index]) return;
    if (isKnown(index)) changes.push({ index, from: control.places[index][0], to: control.places[index][1], text: typed[index] ?? written(value, control.kind) });
  });
  if (!changes.length) return;
  changes.sort((a, b) => a.from - b.from);
  control.values = control.values.map((old, index) => (changes.some((one) => one.index === index) ? values[index] : old));
  for (const one of changes) control.texts[one.index] = one.text;
  // The places after a change move with it.
  const moved = (place) => changes.reduce((sum, one) => sum + (one.to <= place ? one.text.length - (one.to - one.from) : 0), place);
  const grown = new Map(changes.map((one) => [one.from, one.text.length]));
  for (const other of controls) {
    other.places = other.places.map((place) => {
      if (!place) return null;
      const [from, to] = place, begin = moved(from);
      return [begin, grown.has(from) ? begin + grown.get(from) : begin + (to - from)];
    });
  }
  isMoving = true;
  rewrite(scene, changes);
  isMoving = false;
};
const hex = (values) => `#${values.slice(0, 3).map((value) => Math.round(255 * value).toString(16).padStart(2, "0")).join("")}`;
// Takes controls, whose places are those of `raw`, the scene as it was read.
const takeControls = (fresh, raw) => {
  const place = plainPlaces(raw), text = plain(raw);
  for (const control of fresh) {
    control.places = control.places.map((range) => range.map(place));
    control.texts = control.places.map((range) => text.slice(...range));
  }
  byId("controls-panel").hidden = !isLive || fresh.length === 0 || !docs.get(scene)?.isWritable;
  const key = (list) => list.map((control) => `${control.path.join(".")} ${control.kind} ${control.values.length}`).join("\n");
  if (key(fresh) === key(controls)) {
    fresh.forEach((control, index) => {
      const old = controls[index];
      [old.places, old.texts] = [control.places, control.texts];
      if (old.values.some((value, at) => value !== control.values[at])) { old.values = control.values; old.refresh?.(); }
    });
    return;
  }
  controls = fresh;
  swap(byId("controls"), controls.map(controlElement));
};
// The name of a control, without what all of them share in a scene of one draw.
const nameOf = ({ path }) => {
  const draws = new Set(controls.filter((one) => one.path[0] === "draw").map((one) => one.path[1]));
  return (path[0] === "draw" && path[2] === "uniforms" && draws.size === 1 ? path.slice(3) : path).join(" ");
};
const controlElement = (control) => {
  const parts = [];
  const title = nameOf(control);
  const refreshers = [];
  if (control.kind === "bool") {
    const box = html("input", { type: "checkbox", "aria-label": title, "data-key": title, change: () => setControl(control, [box.checked ? 1 : 0]) });
    refreshers.push(() => { box.checked = control.values[0] === 1; });
    parts.push(html("div", { class: "one" }, box));
  } else {
    if (control.kind === "color") {
      const color = html("input", { type: "color", "aria-label": `${title}, color`, "data-key": `${title}, color`, input: () => {
        const rgb = [1, 3, 5].map((at) => Math.round(parseInt(color.value.slice(at, at + 2), 16) / 255 * 1e4) / 1e4);
        setControl(control, [...rgb, ...control.values.slice(3)]); refresh();
      } });
      refreshers.push(() => { color.value = hex(control.values); });
      parts.push(html("div", { class: "one" }, color));
    }
    const names = control.kind === "color" ? "rgba" : "xyzw";
    control.values.forEach((_, index) => {
      const whole = control.kind === "integer";
      const [low, high] = control.kind === "color" ? [0, 1] : control.range;
      const label = control.values.length > 1 ? `${title} ${names[index]}` : title;
      const set = (value, typed) => {
        if (!Number.isFinite(value)) return;
        setControl(control, control.values.map((old, at) => (at === index ? value : old)), { [index]: typed });
        refresh();
      };
      const step = whole ? 1 : (high - low) / 400;
      const slider = html("input", { type: "range", min: low, max: high, step, "aria-label": label, "data-key": label, input: () => set(rounded(Number(slider.value), step)) });
      // What is typed is written, digit by digit.
      const type = () => {
        const typed = typedNumber(box.value, control.kind);
        if (typed === undefined) box.value = control.values[index];
        else set(Number(typed), typed);
      };
      const box = html("input", { type: "number", step: whole ? 1 : "any", "aria-label": `${label}, number`, "data-key": `${label}, number`, change: type });
      refreshers.push(() => { slider.value = control.values[index]; if (document.activeElement !== box) box.value = control.values[index]; });
      const name = control.values.length > 1 ? html("span", { class: "axis", "aria-hidden": "true" }, names[index]) : null;
      parts.push(html("div", { class: "one" }, name, slider, box));
    });
  }
  const refresh = () => refreshers.forEach((one) => one());
  control.refresh = refresh;
  refresh();
  return html("fieldset", {}, html("legend", {}, title), parts);
};

// What gets the focus is not behind the picture, which stays at the top.
new ResizeObserver(([{ target }]) => {
  const stays = getComputedStyle(target).position === "sticky";
  target.parentElement.style.scrollPaddingTop = stays ? `${target.offsetHeight + 8}px` : "";
}).observe(document.querySelector(".results > :first-child"));

// ---- Pictures.
const HINT = byId("pixel").textContent;
const figure = (name, source, width, height, caption) => {
  const image = html("img", { src: source, width, height, alt: name, draggable: "false", style: `--ratio: ${width / height}` });
  image.addEventListener("pointermove", (event) => { if (!turning) point(image, event, width, height); });
  let pressed = null;
  image.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; turn(image, event); });
  image.addEventListener("click", (event) => {
    // A drag turns the camera.
    if (!isLive || !pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
    inspector.inspect(...pixelAt(image, event, width, height));
  });
  image.addEventListener("wheel", (event) => { if (eye()) { event.preventDefault(); move(Math.exp(event.deltaY / 600)); } }, { passive: false });
  return html("figure", {}, image, html("figcaption", {}, html("strong", {}, name), caption ? `: ${caption}` : ""));
};
const showDrawn = (drawn) => {
  isCoarse = drawn.block > 1;
  const old = byId("pictures").querySelector("img");
  if (old && byId("pictures").children.length === 1 && Number(old.getAttribute("width")) === drawn.width && old.dataset.kind === "drawn") old.src = drawn.picture;
  else {
    byId("pictures").replaceChildren(figure("picture", drawn.picture, drawn.width, drawn.height, ""));
    byId("pictures").querySelector("img").dataset.kind = "drawn";
  }
  // The numbers of a pixel were those of the last picture.
  byId("pixel").textContent = HINT;
  // An exported page is the same each time, so it tells no time.
  const time = drawn.milliseconds === undefined ? "" : ` in ${drawn.milliseconds.toFixed(0)} ms`;
  const empty = drawn.is_empty ? "; nothing is covered: no fragment reached a pixel" : "";
  const how = isCoarse ? `, a first look${time}: one pixel of ${drawn.block ** 2}` : (time && `,${time}`) + empty;
  byId("drawn").textContent = `${drawn.width} × ${drawn.height}, by ${drawn.by}${how}`;
};
const hideVerdict = () => { byId("verdict").hidden = byId("says").hidden = byId("report").hidden = true; };
const showJudged = (judged) => {
  const { width, height } = judged;
  byId("pictures").replaceChildren(
    figure("reference", judged.reference, width, height, "in f64"),
    ...(judged.driver ? [figure("GPU", judged.driver, width, height, judged.by)] : []),
    figure("difference", judged.difference, width, height, judged.difference_legend),
    figure("evidence", judged.evidence, width, height, judged.evidence_legend));
  const kinds = { holds: "good", inconclusive: "fair", fails: "bad" };
  byId("verdict").hidden = false;
  byId("verdict").className = `pill ${kinds[judged.verdict] ?? ""}`;
  byId("verdict").textContent = judged.verdict;
  byId("says").hidden = false;
  byId("says").textContent = judged.says;
  byId("drawn").textContent = "";
  byId("report").hidden = isServed || !isLive;
  byId("report").onclick = () => {
    const { verdict, says, by } = judged;
    const report = { scene, verdict, says, by, browser: navigator.userAgent, glisten: start.version, texts: changedTexts() };
    offer("verdict.json", JSON.stringify(report, null, 2));
  };
};
// A picture of the reference that takes longer (ms) is drawn coarsely first, and so is the first one of a scene.
const SLOW = 100;
// A picture that takes longer (ms) than this is announced.
const LATE = 400;
const last = () => (isCoarse ? "a first look at the last picture" : "the last picture");
let pace = { scene: null, milliseconds: 0 };
const draw = isLive ? latest(async ({ isOld, again, yields }) => {
  const gpu = document.querySelector("input[name=by]:checked").value === "gpu";
  const asked = scene;
  if (!asked) return;
  const late = setTimeout(() => {
    if (asked === scene && !isJudging) byId("drawn").textContent = `drawing …${pictured === asked ? `; this is ${last()}` : ""}`;
  }, LATE);
  const show = (answer) => {
    clearTimeout(late);
    if (asked !== scene) return false;
    if (answer.ok) {
      hideVerdict();
      showDrawn(answer.ok);
      pictured = asked;
    } else if (answer.status === 409) { if (!isJudging) again(); }
    else byId("drawn").textContent = `Not drawn${pictured === asked ? `, so this is ${last()}` : ""}: ${answer.error}`;
    return Boolean(answer.ok);
  };
  if (!gpu && (pace.scene !== scene || pace.milliseconds > SLOW)) {
    const isShown = show(await ask({ ask: "draw", gpu, coarse: true }));
    // The whole picture is for a text that rests.
    if (!isShown || isOld()) return;
    yields();
  }
  const answer = await ask({ ask: "draw", gpu });
  if (show(answer) && !gpu) pace = { scene: asked, milliseconds: answer.ok.milliseconds };
}, 600) : () => {};
// The judgement draws too: a picture that waits for its turn would only end it. A change of a text ends it and draws.
const judge = async () => {
  draw.forget();
  isJudging = true;
  enable("judge", false);
  byId("drawn").textContent = "judging …";
  const asked = edition;
  const answer = await ask({ ask: "judge" });
  enable("judge", true);
  isJudging = false;
  if (asked !== edition) return;
  if (answer.ok) { isJudged = true; pictured = scene; showJudged(answer.ok); byId("verdict").scrollIntoView({ block: "nearest" }); }
  else if (answer.status !== 409) byId("drawn").textContent = `Not judged: ${answer.error}`;
};

// The picture of another scene is none of this one.
const forgetPicture = () => {
  pictured = null;
  byId("pictures").replaceChildren();
  byId("drawn").textContent = "";
  byId("pixel").textContent = HINT;
  hideVerdict();
};

// The numbers of the pixel under the pointer.
let wanted = null, isAsking = false;
const pixelAt = (image, event, width, height) => {
  const box = image.getBoundingClientRect();
  const at = (place, size) => Math.max(0, Math.min(size - 1, Math.floor(place * size)));
  return [at((event.clientX - box.left) / box.width, width), at((event.clientY - box.top) / box.height, height)];
};
const point = (image, event, width, height) => {
  wanted = pixelAt(image, event, width, height);
  if (isLive) askPixel();
};
const askPixel = async () => {
  if (isAsking || !wanted) return;
  isAsking = true;
  const [x, y] = wanted;
  wanted = null;
  try {
    const { ok } = await ask({ ask: "pixel", x, y, texts: {} });
    const row = (name, pixel) => (pixel ? `\n${name}: ${pixel.values.join("  ")}${pixel.is_covered ? "" : " (not covered)"}` : "");
    if (ok) byId("pixel").textContent = `pixel ${x}, ${y}${row("reference", ok.reference)}${row("GPU", ok.driver)}${ok.share === null ? "" : `\ndifference: ${ok.share.toFixed(3)} of its bound`}`;
  } catch { /* The next movement asks again. */ }
  isAsking = false;
  if (wanted) askPixel();
};

// ---- The inspector: what the fragments of a pixel computed, step by step.
const inspector = (() => {
  const WINDOW = 150;  // the steps in the list before and after the current one
  let pixel = null, invocations = [], steps = [], now = 0;
  let tracedFor = 0;   // the edition that the steps are for
  const isOld = () => tracedFor !== edition;
  const number = (value) => {
    if (typeof value !== "number") return String(value);
    const single = Math.fround(value), size = Math.abs(single);
    if (single === 0 || (size >= 1e-4 && size < 1e7)) return String(Number(single.toPrecision(7)));
    return single.toExponential(6).replace(/\.?0+e/, "e");
  };
  const list = (values) => (values.length === 1 ? number(values[0]) : `(${values.slice(0, 16).map(number).join(", ")}${values.length > 16 ? ", …" : ""})`);
  const texts = {
    local: (step) => `${step.text} =`, if: (step) => `if (${step.text})`, loop: (step) => `while (${step.text})`,
    switch: (step) => `switch (${step.text})`, call: (step) => `call ${step.text}`, return: (step) => `return from ${step.text}`,
    input: (step) => `in ${step.text}`, output: (step) => `out ${step.text}`,
  };
  const text = (step) => (texts[step.kind] ?? ((other) => other.text))(step);
  const base = (name) => name.split(/[\\/]/).at(-1);
  const place = (step) => (step.file ? `${base(step.file)}:${step.start.line}` : "");
  const told = (step) => (step.value ? list(step.value) : "");
  const fates = { drawn: "drawn", discarded: "discarded", failed: "failed the depth or stencil test" };
  const row = (name, cells) => html("tr", {}, html("th", {}, name), cells.map((cell) => html("td", {}, cell)));
  const show = (index, isAsked = true) => {
    now = Math.max(0, Math.min(steps.length - 1, index));
    const step = steps[now];
    byId("step").value = now;
    ["step-first", "step-back"].forEach((id) => enable(id, now > 0));
    ["step-on", "step-last"].forEach((id) => enable(id, now < steps.length - 1));
    if (!step) return;
    const table = step.value?.length ? html("table", {}, html("tbody", {},
      row(step.exact ? "f32" : step.type, step.value.slice(0, 16).map(number)),
      step.exact ? row("exact", step.exact.slice(0, 16).map(number)) : null,
      step.interval ? row("a GPU may have", step.interval.slice(0, 16).map(([low, high]) => `${number(low)} … ${number(high)}`)) : null)) : null;
    byId("step-now").replaceChildren(
      html("div", {}, `step ${now + 1} of ${steps.length} · ${place(step)}${step.type ? ` · ${step.type}` : ""}${step.is_far ? " · f32 is far from the exact value" : ""}${step.may_be_nan ? " · a GPU may have NaN" : ""}`),
      html("code", {}, text(step)), ...(table ? [table] : []));
    const first = Math.max(0, now - WINDOW);
    const items = steps.slice(first, now + WINDOW + 1).map((one, index) => html("li", {},
      html("button", { "data-key": first + index, tabindex: first + index === now ? 0 : -1, ...(first + index === now ? { "aria-current": "step" } : {}), click: () => show(first + index) },
        html("span", { class: "at" }, place(one)), html("span", { class: "text" }, "  ".repeat(Math.min(one.depth, 12)) + text(one)), html("span", { class: "value" }, told(one)))));
    swap(byId("step-list"), items);
    const current = byId("step-list").querySelector("[aria-current]");
    if (current) byId("step-list").scrollTop = current.offsetTop - byId("step-list").offsetTop - 100;
    // A step of an older text has no place in this one.
    if (!isAsked || !step.file || isOld()) return;
    if (docs.has(step.file)) {
      if (shown !== step.file) open(step.file);
      editor.emphasize(step);
    }
  };
  const choose = (index, isAsked) => {
    const one = invocations[index];
    steps = one?.steps ?? [];
    byId("stepper").hidden = steps.length === 0;
    byId("step").max = Math.max(0, steps.length - 1);
    editor.emphasize(null);
    show(isAsked ? Math.max(0, steps.findIndex((step) => step.kind !== "input")) : now, isAsked);
  };
  const take = (answer, isAsked) => {
    tracedFor = edition;
    byId("stepper").classList.remove("is-old");
    const before = Number(byId("fragments").value) || 0;
    invocations = answer.invocations;
    const drawn = invocations.findLastIndex((one) => one.fate === "drawn");
    const label = (one, index) => `${index + 1}: primitive ${one.primitive} of draw ${one.draw}, ${fates[one.fate] ?? one.fate}`;
    byId("fragments").replaceChildren(...invocations.map((one, index) => html("option", { value: index }, label(one, index))));
    byId("choose-fragment").hidden = invocations.length === 0;
    const chosen = isAsked ? Math.max(0, drawn) : Math.min(before, invocations.length - 1);
    byId("fragments").value = chosen;
    const color = answer.colors?.[0];
    const found = invocations.length === 0 ? "no fragment reached it" : `${invocations.length} fragment${invocations.length > 1 ? "s" : ""}`;
    byId("inspected").textContent = `pixel ${pixel.join(", ")}: ${found}${color ? `; color ${list(color.value)}` : ""}`;
    choose(chosen, isAsked);
    // The step is the same one; its text is marked where it is shown.
    const step = steps[now];
    if (!isAsked && step?.file === shown) editor.emphasize(step);
  };
  let isAsked = false;
  // What is shown is of another pixel, or of older texts.
  const refuse = (reason) => {
    byId("inspected").textContent = `Not inspected: ${reason}`;
    byId("stepper").classList.add("is-old");
  };
  const run = latest(async ({ again }) => {
    const asked = edition, wasAsked = isAsked;
    isAsked = false;
    const answer = await ask({ ask: "trace", x: pixel[0], y: pixel[1] });
    if (asked !== edition || !pixel) return;
    if (answer.ok) take(answer.ok, wasAsked);
    else if (answer.status === 409) again();
    else refuse(answer.error);
  }, 1500);
  // The texts changed.
  const age = () => { if (steps.length && isOld()) byId("stepper").classList.add("is-old"); };
  byId("fragments").addEventListener("change", () => choose(Number(byId("fragments").value), true));
  byId("step").addEventListener("input", () => show(Number(byId("step").value)));
  for (const [id, to] of [["step-first", () => 0], ["step-back", () => now - 1], ["step-on", () => now + 1], ["step-last", () => steps.length - 1]]) byId(id).addEventListener("click", () => show(to()));
  const LARGEST = 2 ** 32 - 1;
  const inspect = (x, y) => {
    if (!(Math.max(x, y) <= LARGEST)) { refuse(`the picture has no pixel ${x}, ${y}`); return; }
    pixel = [x, y];
    [byId("inspect-x").value, byId("inspect-y").value] = pixel;
    isAsked = true;
    run();
  };
  // The list is one stop of the Tab key; arrows go through it.
  const KEYS = { ArrowDown: () => now + 1, ArrowUp: () => now - 1, PageDown: () => now + 10, PageUp: () => now - 10, Home: () => 0, End: () => steps.length - 1 };
  byId("step-list").addEventListener("keydown", (event) => {
    const to = KEYS[event.key];
    if (!to || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    show(to());
    byId("step-list").querySelector("[aria-current]")?.focus({ preventScroll: true });
  });
  byId("inspect").addEventListener("click", () => inspect(Math.max(0, Math.trunc(Number(byId("inspect-x").value))), Math.max(0, Math.trunc(Number(byId("inspect-y").value)))));
  return {
    inspect,
    // The texts changed: the same pixel again.
    refresh: () => { if (pixel) { age(); editor.emphasize(null); run(); } },
    // Another scene.
    forget: () => { pixel = null; invocations = []; steps = []; byId("stepper").hidden = byId("choose-fragment").hidden = true; byId("inspected").textContent = "Click a pixel of the picture."; },
    // The value of the smallest expression at a place: the last one up to the current step, or else the next one.
    valueAt: (name, line, column) => {
      if (isOld()) return null;
      const after = (a, b) => a.line > b.line || (a.line === b.line && a.column > b.column);
      const at = { line, column };
      const size = (step) => (step.end.line - step.start.line) * 1e6 + step.end.column - step.start.column;
      let best = null;
      steps.forEach((step, index) => {
        if (step.file !== name || !step.value || after(step.start, at) || !after(step.end, at)) return;
        const longer = best ? size(step) - size(best) : -1;
        if (longer < 0 || (longer === 0 && index <= now)) best = step;
      });
      if (!best) return null;
      const step = best;
      return `${step.text}: ${step.type}\n${told(step)}${step.is_far ? `\nexact ${list(step.exact)}` : ""}`;
    },
  };
})();

const studies = makeStudies({ ask, open, inspect: inspector.inspect, edition: () => edition, isOwn: (name) => docs.get(name)?.isWritable ?? false, kept: start.studies ?? null, changed: () => mark() });

// The camera turns around its target.
let turning = null;
const named = (...path) => controls.find((control) => control.path.join("/") === path.join("/"));
const eye = () => (isLive ? [named("camera", "eye")].find((control) => control?.values.length === 3) : undefined);
const centre = () => { const found = named("camera", "target"); return found?.values.length === 3 ? found.values : [0, 0, 0]; };
const place = (control, offset) => {
  const to = centre();
  setControl(control, offset.map((value, index) => rounded(value + to[index], Math.hypot(...offset) / 1e3)));
  control.refresh?.();
};
const offset = () => { const to = centre(); return eye().values.map((value, index) => value - to[index]); };
const move = (factor) => place(eye(), offset().map((value) => value * factor));
const turn = (image, event) => {
  const control = eye();
  if (!control || event.button !== 0) return;
  event.preventDefault();
  const from = offset();
  const length = Math.hypot(...from) || 1;
  const began = { x: event.clientX, y: event.clientY, length, around: Math.atan2(from[0], from[2]), up: Math.asin(Math.max(-1, Math.min(1, from[1] / length))) };
  turning = began;
  const moved = (now) => {
    const around = began.around - (now.clientX - began.x) / 120;
    const up = Math.max(-1.55, Math.min(1.55, began.up + (now.clientY - began.y) / 120));
    place(control, [Math.sin(around) * Math.cos(up), Math.sin(up), Math.cos(around) * Math.cos(up)].map((value) => value * began.length));
  };
  const ended = () => {
    turning = null;
    byId("pictures").classList.remove("is-turning");
    removeEventListener("pointermove", moved); removeEventListener("pointerup", ended);
  };
  byId("pictures").classList.add("is-turning");
  addEventListener("pointermove", moved); addEventListener("pointerup", ended);
};

// ---- Scenes, saving, changes on disk.
const mayLeave = () => ![...docs.values()].some(isEdited) || confirm("Changes that are not saved will be gone. Go on?");
// Shows another scene. `texts` has those of its files that differ from the disk.
const enter = (name, texts = []) => {
  docs.clear(); findings = []; controls = []; programs = []; stage = null; draft = null;
  for (const [file, doc] of texts) docs.set(file, { isWritable: true, ...doc });
  edition += 1;
  isJudged = isJudging = false;
  scene = name;
  shown = null;
  inspector.forget(); studies.forget(); forgetPicture(); conflicts.forget();
  unsay("look", "saved", "new", "person");
  look(); draw();
};
const choose = (name, texts) => {
  if (!mayLeave()) return false;
  if (!isServed && location.hash) history.replaceState(null, "", location.pathname + location.search);
  enter(name, texts);
  return true;
};
// A text that is in no file yet.
const fresh = (text) => ({ ...asRead(text), saved: null, made: plain(text), isWritable: true });
// The files of a new scene: itself, and a shader that was missing.
const newTexts = ({ name, text, others }) => [[name, fresh(text)], ...Object.entries(others).map(([other, text]) => [other, fresh(text)])];
const NEW = "this scene is new: Save writes it";
// The shaders of the scene, while it is a draft: they have errors, and only without them is it known what it has to provide.
let draft = null;
// Makes a scene of a draft as soon as the shaders allow it, unless a person writes it.
const finish = async () => {
  if (!draft) return;
  const asked = edition, of = scene, { [of]: _, ...texts } = changedTexts();
  const made = await request("POST", "/api/new-scene", { page, files: draft, scene: of, texts });
  if (asked !== edition || of !== scene || !draft || made.is_draft || !made.text) return;
  const isOwn = isEdited(docs.get(scene));
  draft = null;
  if (isOwn) return;
  for (const [name, doc] of newTexts(made)) {
    if (docs.has(name)) setText(name, docs.get(name), doc.text);
    docs.set(name, { ...docs.get(name), ...doc });
    if (name === shown) editor.set(doc.text);
  }
  textChanged();
  say(NEW, false, "new");
};
let listed = null;
const showScenes = ({ scenes, drawable = [] }) => {
  const option = (value, label) => html("option", { value }, label);
  // A scene that is new, or gone, is in the list as long as it is shown.
  const own = scene && !scenes.includes(scene) ? [option(scene, docs.get(scene)?.saved === null ? `${scene} (new)` : scene)] : [];
  const all = [...own, ...scenes.map((name) => option(name, name))];
  listed = { scenes, drawable };
  byId("scenes").replaceChildren(
    ...(all.length ? [html("optgroup", { label: "Scenes" }, all)] : []),
    ...(drawable.length ? [html("optgroup", { label: "New scene for" }, drawable.map((files) => option(JSON.stringify(files), files.join(", "))))] : []));
  if (scene) byId("scenes").value = scene;
};
const refreshScenes = async () => {
  const { scenes, drawable } = await request("GET", "/api/list");
  // An open list is not disturbed without need.
  if (scenes && JSON.stringify({ scenes, drawable }) !== JSON.stringify(listed)) showScenes({ scenes, drawable });
  if (scenes && !scene) first();
};
// Who keeps unsaved changes keeps the scene, too: the list says so.
const showScene = () => { if (scene) byId("scenes").value = scene; };
const chosen = async (value) => {
  if (!value.startsWith("[")) { if (choose(value) && listed) showScenes(listed); showScene(); return; }
  say("writing a scene …");
  const files = JSON.parse(value);
  const made = await request("POST", "/api/new-scene", { page, files });
  if (made.text && choose(made.name, newTexts(made))) {
    showScenes(listed);
    if (made.is_draft) draft = files;
    else say(NEW, false, "new");
  } else { showScene(); say(made.error ?? "", Boolean(made.error)); }
};
// Shows what the page begins with, once there is something.
const first = () => {
  if (start.program) chosen(JSON.stringify(start.program));
  else if (scene ?? start.scene) choose(scene ?? start.scene);
  else if (byId("scenes").options.length) chosen(byId("scenes").value);
  else say("this folder has neither a scene nor a shader", true);
  showScene();
};
const conflicts = makeConflicts({
  write: async (name, was) => {
    const doc = docs.get(name), text = doc.text, raw = restored(text, was ?? "");
    const answer = await request("POST", "/api/save", { name, text: raw, was });
    if (answer.ok) Object.assign(doc, { saved: text, raw, isGone: false });
    return answer;
  },
  take: (name, disk) => { follow(name, docs.get(name), disk); textChanged(); },
  done: () => { say("saved", false, "saved"); showFiles(); refreshScenes(); },
  fail: (text) => { showFiles(); say(text, true); },
  focus: () => editor.focus(),
});
const unsaved = () => [...docs].filter(([, doc]) => isUnsaved(doc)).map(([name, doc]) => [name, doc.saved === null || doc.isGone ? null : doc.raw]);
const save = () => conflicts.save(unsaved);
// Without a server, the files go to the folder of downloads.
const offer = (name, text) => {
  const link = html("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
};
const download = () => {
  for (const [name, doc] of docs) if (isUnsaved(doc)) offer(name.split(/[\\/]/).at(-1), restored(doc.text, doc.raw));
};
const share = async () => {
  try {
    history.replaceState(null, "", `#${await packed({ scene, texts: changedTexts() })}`);
    const isCopied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
    say(`the address of this page holds its texts now${isCopied ? "; it is copied" : ""}`);
  } catch (error) { say(`no link: ${error.message}`, true); }
};
// Opens the scene and the texts of a link. Only files that the page holds have texts.
const openLink = async (text) => {
  const state = await unpacked(text);
  if (!start.list.scenes.includes(state.scene)) throw new Error(`this page has no scene ${state.scene}`);
  const held = new Map(Object.keys(start.files).map((name) => [plainName(name), start.files[name].text]));
  const raw = (name) => held.get(plainName(name));
  const texts = Object.entries(state.texts).filter(([name]) => raw(name) !== undefined);
  enter(state.scene, texts.map(([name, own]) => [name, { ...asRead(raw(name)), text: plain(own) }]));
};
const showGallery = () => {
  const base = (name) => name.split(/[\\/]/).at(-1).replace(/\.toml$/, "");
  byId("gallery").hidden = start.gallery.length < 2;
  byId("cards").replaceChildren(...start.gallery.map(({ scene: name, picture }) => html("button", { title: name, click: () => {
    if (choose(name) === false) return;
    byId("scenes").value = name;
    byId("gallery").open = false;
  } }, html("img", { src: picture, alt: "", loading: "lazy" }), html("span", {}, base(name).replaceAll("_", " ")))));
};
// One page of a browser waits for changes and tells the others: a browser has few connections to a server.
const watch = () => {
  const others = new BroadcastChannel("changes");
  let number = 0;
  const hear = (now) => {
    if (now === number) return;
    number = now;
    look(); refreshScenes();
    if (!isJudged && !isJudging) draw();
  };
  others.onmessage = ({ data }) => hear(data);
  setInterval(() => { if (!said.isLast) request("POST", `/api/here?page=${page}`); }, 30000);
  navigator.locks.request("changes", async () => {
    // One request may fail: after sleep, or when a network changes.
    for (let failed = 0; failed < 4;) {
      const answer = await request("GET", `/api/changes?since=${number}&page=${page}`);
      failed = answer.status === 0 ? failed + 1 : 0;
      if (answer.number === undefined) await new Promise((resolve) => setTimeout(resolve, 500));
      else if (answer.number !== number) { others.postMessage(answer.number); hear(answer.number); }
    }
    sayLast();
  });
};

byId("target").replaceChildren(...start.targets.map(({ word, name }) => html("option", { value: word }, name)));
byId("study-variants").hidden = !isServed;
if (isLive) {
  byId("save").hidden = false;
  byId("save").addEventListener("click", isServed ? save : download);
  byId("scenes").addEventListener("change", () => chosen(byId("scenes").value));
  byId("target").addEventListener("change", look);
  byId("leaves-out").addEventListener("change", look);
  byId("judge").addEventListener("click", judge);
  all("input[name=by]").forEach((radio) => radio.addEventListener("change", draw));
  addEventListener("keydown", (event) => { if ((event.ctrlKey || event.metaKey) && !event.shiftKey && !event.altKey && event.key.toLowerCase() === "s") { event.preventDefault(); (isServed ? save : download)(); } });
  addEventListener("beforeunload", (event) => { if ([...docs.values()].some(isEdited)) event.preventDefault(); });
  scene = start.scene;
  showScenes(start.list);
  if (!scene && !start.program) scene = start.list.scenes[0] ?? null;
  if (isServed) {
    first();
    watch();
    // Nobody waits for what its workers do.
    addEventListener("pagehide", () => navigator.sendBeacon(`/api/gone?token=${start.token}&page=${page}`));
  } else {
    // What draws here is the reference, and WebGPU where the browser has it.
    byId("judge").hidden = byId("by").hidden = true;
    computing.hasGpu().then((has) => { byId("judge").hidden = byId("by").hidden = !has; });
    byId("share").hidden = false;
    byId("share").addEventListener("click", share);
    showGallery();
    const begin = async (event) => {
      if (event && !mayLeave()) { history.replaceState(null, "", event.oldURL); return; }
      const link = location.hash.slice(1);
      byId("gallery").open = !link && start.gallery.length > 1;
      try { if (link) await openLink(link); else enter(scene); }
      catch (error) { enter(start.scene); say(`the link cannot be opened: ${error.message}`, true); }
      byId("scenes").value = scene;
    };
    addEventListener("hashchange", begin);
    begin();
  }
} else {
  scene = start.scene;
  byId("choose-scene").hidden = byId("judge").hidden = byId("by").hidden = byId("inspector").hidden = true;
  byId("pixel").textContent = `This page shows one state of the scene. \`glisten play ${scene}\` draws it again while it changes.`;
  const show = () => {
    const key = target() + (byId("leaves-out").checked ? "-left-out" : "");
    take({ ...start.look, programs: start.look.by_target[key] ?? [] });
  };
  byId("target").addEventListener("change", show);
  byId("leaves-out").addEventListener("change", show);
  show();
  if (start.judged.verdict) showJudged(start.judged);
  else { showDrawn(start.drawn); byId("drawn").textContent += `. Not judged: ${start.judged.error}`; }
}
