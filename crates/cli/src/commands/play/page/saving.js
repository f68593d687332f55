
// ---- Saving to the files of a server, one after the other. A file that changed on disk meanwhile is a choice for a person, which stays until
// it is made.
// `docs` are the files; `write` sends one, `take` takes the text that is on disk, `done` is called when all is saved, `focus` when a choice was made.
const makeConflicts = ({ write, take, done, fail, focus }) => {
  const panel = byId("conflict");
  let open = null;
  const forget = () => {
    open = null;
    panel.hidden = true;
    panel.replaceChildren();
  };
  const solved = (work) => async () => {
    const { name, disk } = open ?? {};
    forget();
    // The button is gone.
    focus();
    if (name !== undefined) await work(name, disk);
  };
  const show = (name, answer) => {
    open = { name, disk: answer.disk };
    const button = (label, work) => html("button", { click: solved(work) }, label);
    panel.hidden = false;
    panel.replaceChildren(html("span", {}, `${name}: ${answer.error}. Which text counts?`),
      button("Take the text on disk", (name, disk) => { take(name, disk); return pending().length ? saveAll() : null; }),
      button("Overwrite it with this one", (name, disk) => saveOne(name, disk).then((isSaved) => isSaved && saveAll())));
  };
  // Saves a file in place of a text; whether it is saved.
  const saveOne = async (name, was) => {
    const answer = await write(name, was);
    if (answer.ok) return true;
    if (answer.disk !== undefined) show(name, answer);
    else fail(`${name}: ${answer.error}`);
    return false;
  };
  let pending = () => [];
  const saveAll = async () => {
    for (const [name, was] of pending()) if (!await saveOne(name, was)) return;
    done();
  };
  return { forget, save: (list) => { pending = list; forget(); return saveAll(); } };
};
