//! [`Readable`]: packs of Minecraft as glslang can read them.
//!
//! *In:* a pack, the assets of a game. *Out:* a tree whose sources include by `#include`. *Holds:* each included file is read once, without its
//! `#version`; what a pack has comes before what the game has.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A tree that glslang can read.
pub(crate) struct Readable {
    /// Its sources, under the names that they have in the pack.
    pub(crate) root: PathBuf,
    /// The files that they include.
    pub(crate) includes: PathBuf,
}

impl Readable {
    /// A tree whose includes glslang can read.
    pub(crate) fn as_it_is(folder: &Path) -> Self {
        Self { root: folder.to_owned(), includes: folder.to_owned() }
    }

    /// A pack, which is copied.
    pub(crate) fn of_pack(pack: &Path, game: Option<&Path>, to: &Path) -> io::Result<Self> {
        let tree = Self { root: to.join("sources"), includes: to.join("includes") };
        for folder in
            game.into_iter().flat_map(|game| [game.join("include"), game.join("assets/minecraft/shaders/include")])
        {
            tree.copy_includes(&folder, "minecraft")?;
        }
        let mut open = vec![pack.to_owned()];
        while let Some(folder) = open.pop() {
            if folder.ends_with("include") {
                let own = folder.ancestors().nth(2).filter(|_| folder.ends_with("shaders/include"));
                let namespace = own.and_then(Path::file_name).and_then(|name| name.to_str());
                tree.copy_includes(&folder, namespace.unwrap_or("minecraft"))?;
                continue;
            }
            for entry in fs::read_dir(&folder)? {
                let path = entry?.path();
                if path.is_dir() {
                    open.push(path);
                } else if let (true, Ok(name)) = (is_source(&path), path.strip_prefix(pack)) {
                    let text = String::from_utf8_lossy(&fs::read(&path)?).into_owned();
                    written(&tree.root.join(name), &with_includes(&text))?;
                }
            }
        }
        Ok(tree)
    }

    /// Copies the included files of a folder.
    fn copy_includes(&self, folder: &Path, namespace: &str) -> io::Result<()> {
        let mut open = vec![folder.to_owned()];
        while let Some(path) = open.pop() {
            if path.is_dir() {
                for entry in fs::read_dir(&path)? {
                    open.push(entry?.path());
                }
            } else if let (true, Ok(name)) = (path.is_file(), path.strip_prefix(folder)) {
                let text = String::from_utf8_lossy(&fs::read(&path)?).into_owned();
                let lines: String =
                    with_includes(&text)
                        .lines()
                        .map(|line| {
                            if line.trim_start().starts_with("#version") {
                                "\n".to_owned()
                            } else {
                                format!("{line}\n")
                            }
                        })
                        .collect();
                let word: String = format!("{namespace}/{}", name.display())
                    .chars()
                    .map(|c| if c.is_alphanumeric() { c } else { '_' })
                    .collect();
                let word = word.replace("__", "_");
                let once = format!("#ifndef READ_{word}\n#define READ_{word}\n{lines}\n#endif\n");
                written(&self.includes.join(namespace).join(name), &once)?;
            }
        }
        Ok(())
    }
}

/// Whether a file is a source.
fn is_source(path: &Path) -> bool {
    path.extension().is_some_and(|extension| ["vsh", "fsh"].iter().any(|word| extension == *word))
}

/// A text that includes by `#include`, with the namespace as a folder.
fn with_includes(text: &str) -> String {
    let line = |line: &str| {
        let directive = line.trim_start();
        let rest = directive.strip_prefix("#moj_import").or(directive.strip_prefix("#include"));
        let path = rest.and_then(|rest| rest.trim().strip_prefix(['<', '"'])?.split(['>', '"']).next());
        match path {
            Some(path) => {
                let (namespace, path) = path.split_once(':').unwrap_or(("minecraft", path));
                format!("#include \"{namespace}/{path}\"\n")
            }
            None => format!("{line}\n"),
        }
    };
    text.lines().map(line).collect()
}

fn written(path: &Path, text: &str) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    fs::write(path, text)
}
