// Lines of the source and of its translation that belong together: the line under the pointer or with the cursor, and its partners, are
// shown in both texts.
//
// `editor` and `translation` are the editors; `shown` tells the name of the text in the first, `stage` what the second shows, with rows of
// `lines` (a line, the number of a file, the first and the last line there), `files` the names of files by number; `open` shows a file.
const makeMatching = ({ editor, translation, shown, stage, files, open }) => {
  const rows = () => (stage()?.lines ?? []).map(([line, file, from, to]) => ({ line, file: files()[file], from, to }));
  // A statement with others in it stands for the lines before the first of them.
  const own = (row, all) => {
    const inner = all.filter((other) => other.file === row.file && other.from > row.from && other.to <= row.to).map((other) => other.from);
    return { ...row, to: Math.max(row.from, Math.min(row.to, ...inner.map((from) => from - 1))) };
  };
  // How far the text of a row goes in the translation: up to the next row, without braces that only close.
  const reach = (row, starts, lines) => {
    const next = starts.find((line) => line > row.line) ?? lines.length + 1;
    const found = [row.line];
    for (let line = row.line + 1; line < next && !/^\s*(}.*)?$/.test(lines[line - 1]); line += 1) found.push(line);
    return found;
  };
  let known = { of: null, rows: [] };
  const told = () => {
    if (known.of !== stage()) {
      const all = rows();
      const starts = [...new Set(all.map((row) => row.line))].sort((a, b) => a - b);
      const lines = translation.text().split("\n");
      known = { of: stage(), rows: all.map((row) => ({ ...own(row, all), lines: reach(row, starts, lines) })) };
    }
    return known.rows;
  };
  const show = (chosen) => {
    editor.match(chosen.filter((row) => row.file === shown()).flatMap((row) => Array.from({ length: row.to - row.from + 1 }, (_, index) => row.from + index)));
    translation.match(chosen.flatMap((row) => row.lines));
    return chosen;
  };
  const ofSource = (line) => show(told().filter((row) => row.file === shown() && row.from <= line && line <= row.to));
  const ofTranslation = (line) => {
    const all = told();
    const mine = all.filter((row) => row.lines.includes(line));
    // What else its lines of the source have become.
    return show(all.filter((row) => mine.some((one) => one.file === row.file && one.from === row.from && one.to === row.to)));
  };
  // What is shown while no pointer is in a text, and what is shown now.
  let kept = () => show([]);
  let now = kept;
  const shows = (work) => { now = work; return work(); };
  const firstLine = (chosen) => Math.min(...chosen.map((row) => row.line));
  const pointed = (of, reveal) => (line) => {
    if (line === null) { shows(kept); return; }
    const chosen = shows(() => of(line));
    if (chosen.length) reveal(chosen);
  };
  return {
    pointedInSource: pointed(ofSource, (chosen) => translation.reveal(firstLine(chosen))),
    pointedInTranslation: pointed(ofTranslation, ([first]) => { if (first.file === shown()) editor.reveal(first.from); }),
    // The cursor's partners stay, and come into sight if a person has moved it.
    movedInSource: (line, isPerson) => {
      kept = () => ofSource(line);
      const chosen = shows(kept);
      if (chosen.length && isPerson) translation.reveal(firstLine(chosen));
    },
    movedInTranslation: (line, isPerson) => {
      if (!isPerson) return;
      kept = () => ofTranslation(line);
      const [first] = shows(kept);
      if (!first) return;
      if (first.file !== shown()) { open(first.file); kept(); }
      editor.reveal(first.from);
    },
    // The translation is another: the same lines of the source again.
    refresh: () => { now(); },
  };
};
