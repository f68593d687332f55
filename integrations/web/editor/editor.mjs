// The editor of the page of `glisten play`: CodeMirror 6 with GLSL, WGSL and TOML, findings as marks with their fixes, and edits
// at places. The page's script knows only what this file exports.

import { autocompletion, closeBrackets, closeBracketsKeymap, completeAnyWord, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { StreamLanguage, bracketMatching, foldGutter, foldKeymap, indentOnInput, indentUnit, syntaxHighlighting, HighlightStyle } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Annotation, Compartment, EditorState, StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";

// The colors are those of the page, which has a light and a dark set.
const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--com)" },
  { tag: tags.keyword, color: "var(--key)" },
  { tag: [tags.typeName, tags.standard(tags.name)], color: "var(--typ)" },
  { tag: [tags.number, tags.bool], color: "var(--num)" },
  { tag: tags.string, color: "var(--str)" },
  { tag: [tags.meta, tags.heading], color: "var(--pre)" },
]);

const theme = EditorView.theme({
  "&": { height: "100%", fontSize: ".82rem", backgroundColor: "var(--card)", color: "var(--ink)" },
  "&.cm-focused": { outline: "2px solid var(--accent)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "var(--code)", lineHeight: "1.5", overflow: "auto" },
  ".cm-content": { caretColor: "var(--ink)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": { backgroundColor: "var(--quiet)", color: "var(--soft)", border: "0" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--ink) 5%, transparent)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "color-mix(in srgb, var(--accent) 28%, transparent) !important" },
  ".cm-tooltip, .cm-panels": { backgroundColor: "var(--card)", color: "var(--ink)", border: "1px solid var(--rule)" },
  ".cm-step": { backgroundColor: "color-mix(in srgb, var(--accent) 34%, transparent)", outline: "1px solid var(--accent)" },
  ".cm-needless": { textDecoration: "line-through", textDecorationColor: "var(--soft)" },
  ".cm-match": { backgroundColor: "color-mix(in srgb, var(--num) 16%, transparent)" },
  ".cm-value": { padding: ".2rem .5rem", fontFamily: "var(--code)", whiteSpace: "pre" },
  ".cm-diagnosticAction": { backgroundColor: "var(--accent)", color: "var(--on-pill)" },
  ".cm-panels input, .cm-panels button": { font: "inherit" },
});

// A language by its words: comments, strings, numbers, directives and the classes of words.
const language = (kind, words) => {
  const classes = new Map();
  for (const [tag, list] of Object.entries(words)) for (const word of list) classes.set(word, tag);
  const comment = kind === "toml" ? "#" : "//";
  const token = (stream, state) => {
    if (state.open) {
      if (stream.skipTo(state.open)) { stream.match(state.open); const of = state.of; state.open = null; return of; }
      stream.skipToEnd();
      return state.of;
    }
    if (stream.eatSpace()) return null;
    if (stream.match(comment)) { stream.skipToEnd(); return "comment"; }
    if (kind !== "toml" && stream.match("/*")) { state.open = "*/"; state.of = "comment"; return "comment"; }
    if (kind === "toml") {
      for (const quotes of ['"""', "'''"]) if (stream.match(quotes)) { state.open = quotes; state.of = "string"; return "string"; }
      if (stream.sol() && stream.match(/^\[\[?[^\]]*\]\]?/)) return "heading";
      if (stream.match(/^"(?:[^"\\]|\\.)*"?|^'[^']*'?/)) return "string";
    }
    if (kind === "glsl" && stream.match(/^#\s*\w*/)) return "meta";
    if (kind === "wgsl" && stream.match(/^@\w+/)) return "meta";
    if (stream.match(/^(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:lf|LF|[fFuUhi])?/)) return "number";
    const word = stream.match(/^[A-Za-z_]\w*/);
    if (word) return classes.get(word[0]) ?? null;
    stream.next();
    return null;
  };
  return StreamLanguage.define({
    name: kind,
    startState: () => ({ open: null, of: null }),
    copyState: (state) => ({ ...state }),
    token,
    languageData: { commentTokens: kind === "toml" ? { line: "#" } : { line: "//", block: { open: "/*", close: "*/" } } },
    tokenTable: { builtin: tags.standard(tags.name), type: tags.typeName },
  });
};

// Texts that the page sets are no changes by a person.
const ofPage = Annotation.define();

// The expression that a person looks at.
const setStep = StateEffect.define();
const step = StateField.define({
  create: () => Decoration.none,
  update: (old, change) => {
    const asked = change.effects.filter((effect) => effect.is(setStep)).at(-1);
    if (!asked) return old.map(change.changes);
    const { from, to } = asked.value ?? {};
    return from < to ? Decoration.set([Decoration.mark({ class: "cm-step" }).range(from, to)]) : Decoration.none;
  },
  provide: (field) => EditorView.decorations.from(field),
});

// Lines that are shown in another way, until others are: each has the place where it begins, and the words for a pointer.
const linesOf = (name) => {
  const set = StateEffect.define();
  const field = StateField.define({
    create: () => Decoration.none,
    update: (old, change) => {
      const asked = change.effects.filter((effect) => effect.is(set)).at(-1);
      if (!asked) return old.map(change.changes);
      const line = ({ from, title }) => Decoration.line({ class: name, ...(title ? { attributes: { title } } : {}) }).range(from);
      return Decoration.set(asked.value.map(line));
    },
    provide: (field) => EditorView.decorations.from(field),
  });
  return { set, field };
};
// The lines that a picture does without, and those that belong to a line of another text.
const needless = linesOf("cm-needless");
const matching = linesOf("cm-match");

// An editor in `parent`, whose texts nobody can change if it is `readOnly`. `changed` is called with the text when a person, a fix or a control changes it; `moved` with the line
// where the cursor is, and whether a person moved it there; `pointed` with the line under the pointer, or null; `valueAt` gives the text to show for a place of a text, by its name, line and column (in characters), or null.
export const create = ({ parent, readOnly = false, label = "", words = {}, changed = () => {}, moved = () => {}, pointed = () => {}, valueAt = () => null }) => {
  const spoken = new Compartment();
  const states = new Map();
  let current = null;
  const listen = EditorView.updateListener.of((update) => {
    const byPage = update.transactions.some((one) => one.annotation(ofPage));
    if (update.docChanged && !byPage) changed(current, update.state.doc.toString());
    if (update.selectionSet || update.docChanged) moved(update.state.doc.lineAt(update.state.selection.main.head).number, update.transactions.some((one) => one.isUserEvent("select")));
  });
  let under = null;
  const point = (line) => {
    if (line !== under) pointed(line);
    under = line;
  };
  const pointer = EditorView.domEventHandlers({
    mousemove: (event, view) => {
      const place = view.posAtCoords({ x: event.clientX, y: event.clientY });
      point(place === null ? null : view.state.doc.lineAt(place).number);
    },
    mouseleave: () => point(null),
  });
  const values = hoverTooltip((view, place) => {
    const line = view.state.doc.lineAt(place);
    const column = Array.from(line.text.slice(0, place - line.from)).length + 1;
    const told = valueAt(current, line.number, column);
    if (told === null) return null;
    const create = () => {
      const dom = document.createElement("div");
      dom.className = "cm-value";
      dom.textContent = told;
      return { dom };
    };
    return { pos: place, above: true, create };
  }, { hoverTime: 150 });
  const extensions = (kind, readOnly) => [
    lineNumbers(), foldGutter(), history(), drawSelection(), indentOnInput(), bracketMatching(), closeBrackets(),
    highlightActiveLine(), highlightActiveLineGutter(), highlightSelectionMatches(), indentUnit.of("    "),
    label === "Translation" ? [] : lintGutter(), readOnly ? [] : [autocompletion({ override: [completeAnyWord] })],
    keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...foldKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
    spoken.of(language(kind, words[kind] ?? {})), syntaxHighlighting(colors), theme, listen, pointer, step, needless.field, matching.field, values,
    EditorState.readOnly.of(readOnly), EditorView.editable.of(true),
    EditorView.contentAttributes.of({ "aria-label": label, spellcheck: "false" }),
  ];
  const view = new EditorView({ parent });
  const fresh = (text, kind, readOnly) => EditorState.create({ doc: text, extensions: extensions(kind, readOnly) });
  const clamp = (place) => Math.max(0, Math.min(view.state.doc.length, place));
  const placeOf = (line, column) => {
    const doc = view.state.doc;
    const at = doc.line(Math.max(1, Math.min(doc.lines, line)));
    // Columns count characters; places count UTF-16 code units.
    const before = Array.from(at.text).slice(0, Math.max(0, column - 1)).join("").length;
    return Math.min(at.to, at.from + before);
  };
  const placesOf = (lines) => {
    const doc = view.state.doc;
    const byLine = new Map(lines.filter(({ line }) => line >= 1 && line <= doc.lines).map(({ line, title }) => [line, title]));
    return [...byLine].sort(([a], [b]) => a - b).map(([line, title]) => ({ from: doc.line(line).from, title }));
  };
  // Brings a place into sight within the editor. The page around it stays where it is.
  const scrollTo = (place) => {
    const { top, bottom } = view.lineBlockAt(place);
    const { scrollTop, clientHeight } = view.scrollDOM;
    if (top < scrollTop || bottom > scrollTop + clientHeight) view.scrollDOM.scrollTop = Math.max(0, (top + bottom - clientHeight) / 2);
  };
  return {
    // Shows a text by its name, which nobody can change if it is `isFixed`; the history and the cursor of each name are kept.
    show(name, text, kind, isFixed = readOnly) {
      // Another state would be laid out anew, even with the same text.
      if (name === current) { this.set(text); return; }
      if (current !== null) states.set(current, view.state);
      const kept = states.get(name);
      current = name;
      if (kept && kept.doc.toString() === text) view.setState(kept);
      else if (kept) { view.setState(kept); this.set(text); }
      else view.setState(fresh(text, kind, isFixed));
    },
    // Puts another text in place of the shown one, as a change that can be undone.
    set(text) {
      if (view.state.doc.toString() === text) return;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text }, annotations: ofPage.of(true) });
    },
    text: () => view.state.doc.toString(),
    name: () => current,
    // Marks findings. Each has line, column, end_line, end_column, severity, message and fixes; `apply` is called with a fix.
    mark(findings, apply) {
      const severities = { error: "error", warning: "warning", note: "info" };
      const marks = findings.map((finding) => {
        const from = placeOf(finding.line, finding.column);
        const to = Math.max(from, placeOf(finding.end_line, finding.end_column));
        return {
          from, to, severity: severities[finding.severity] ?? "info", source: finding.code,
          message: finding.message + (finding.help ? `\nhelp: ${finding.help}` : ""),
          actions: finding.fixes.map((fix) => ({ name: fix.title, apply: () => apply(fix) })),
        };
      });
      view.dispatch(setDiagnostics(view.state, marks));
    },
    // Rewrites places of the shown text, which are given in ascending order.
    rewrite(changes) {
      view.dispatch({ changes: changes.map(({ from, to, text }) => ({ from: clamp(from), to: clamp(to), insert: text })) });
    },
    placeOf,
    // Emphasizes the text between two places (line and column), in sight; none of a null.
    emphasize(range) {
      const place = range && { from: placeOf(range.start.line, range.start.column), to: placeOf(range.end.line, range.end.column) };
      view.dispatch({ effects: setStep.of(place) });
      if (place) scrollTo(place.from);
    },
    // Crosses out lines; each has a line and a title that says why.
    cross(lines) {
      view.dispatch({ effects: needless.set.of(placesOf(lines)) });
    },
    // Shows that lines, by their numbers, belong to a line of another text.
    match(lines) {
      view.dispatch({ effects: matching.set.of(placesOf(lines.map((line) => ({ line })))) });
    },
    // Moves to a line and column.
    go(line, column = 1) {
      const place = placeOf(line, column);
      view.dispatch({ selection: { anchor: place }, effects: EditorView.scrollIntoView(place, { y: "center" }) });
      view.focus();
    },
    // Scrolls to a line without taking the focus.
    reveal(line) { scrollTo(placeOf(line, 1)); },
    focus() { view.focus(); },
  };
};
