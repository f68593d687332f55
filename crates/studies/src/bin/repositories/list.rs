//! [`List`]: the repositories, as `repositories.toml` describes them, with what is known about disagreements.
//!
//! *In:* the text of the file. *Out:* what to look for in each folder, and the flags of `glisten` for it.

use serde::Deserialize;

/// The file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct List {
    /// The repositories.
    pub(crate) repository: Vec<Repository>,
    /// Explained disagreements.
    #[serde(default)]
    pub(crate) note: Vec<Note>,
}

/// A repository.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Repository {
    /// `owner/name`, as on GitHub. Its folder is `owner+name`.
    pub(crate) name: String,
    /// The part of it, if it has several rows.
    #[serde(default)]
    pub(crate) part: Option<String>,
    /// The kind of programs in it.
    pub(crate) kind: String,
    /// The commit that the table is about.
    pub(crate) commit: String,
    /// The folders to search, relative to the repository. Default: all of it.
    #[serde(default)]
    pub(crate) folders: Vec<String>,
    /// Flags as those of `glisten lint`. `{}` is the folder of the repository, `{all}` that of all repositories.
    #[serde(default)]
    pub(crate) flags: Vec<String>,
    /// The text that the engine puts before each source.
    #[serde(default)]
    pub(crate) prelude: Option<String>,
    /// Endings of pages whose scripts are shaders.
    #[serde(default)]
    pub(crate) scripts: Vec<String>,
    /// Parts of paths that are left out, and are no complete shaders by what the repository says itself.
    #[serde(default)]
    pub(crate) without: Vec<String>,
}

/// A disagreement that is explained.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Note {
    /// The repository, or `*` for all.
    pub(crate) repository: String,
    /// A part of the path or of the message.
    pub(crate) about: String,
    /// The reason, with the section of the specification.
    pub(crate) because: String,
}

impl Repository {
    /// The name of its row.
    pub(crate) fn shown(&self) -> String {
        self.part.as_ref().map_or_else(|| self.name.clone(), |part| format!("{}, {part}", self.name))
    }

    /// The name of its folder.
    pub(crate) fn folder(&self) -> String {
        self.name.replace('/', "+")
    }
}

impl List {
    /// The explanation of a disagreement.
    pub(crate) fn because(&self, repository: &str, class: &str, path: &str, message: &str) -> Option<&str> {
        let fits = |note: &&Note| {
            ["*", repository].contains(&note.repository.as_str())
                && [class, path, message].iter().any(|text| text.contains(&note.about))
        };
        self.note.iter().find(fits).map(|note| note.because.as_str())
    }
}
