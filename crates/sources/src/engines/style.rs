//! [`Style`]: how the sources of an engine name the files that they include.
//!
//! *In:* the name in an include. *Out:* the paths below a search folder at which the file may be. *Holds:* a style is one row
//! of [`STYLES`].

use glisten_front::source::ImportDirective;

/// A way to name included files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// `#include "x"` and `#include <x>`, as in GLSL.
    Quote,
    /// `#moj_import <namespace:x>`: Minecraft.
    Moj,
    /// `#include <chunk>`: three.js.
    Three,
    /// `#stk_include "x"`, below the folder of all shaders: SuperTuxKart.
    Stk,
    /// A file's name alone, anywhere below the search folders: OGRE.
    Ogre,
}

/// The properties of a style.
#[derive(Clone, Copy, Debug)]
pub struct Lookup {
    /// The style.
    pub style: Style,
    /// Its name on the command line and in `glisten.toml`.
    pub name: &'static str,
    /// The engine's own directive.
    pub directive: Option<ImportDirective>,
    /// The paths below a search folder, with `{namespace}` and `{path}`.
    pub patterns: &'static [&'static str],
    /// Paths from the folder of the including file, which are tried last.
    pub from_here: &'static [&'static str],
    /// The names of folders above a source that are search folders, too.
    pub ancestors: &'static [&'static str],
    /// Whether the folders above a source, and paths from its own, come before the search folders that were given: what a pack
    /// has replaces what the game has.
    pub own_first: bool,
    /// A file that marks a folder above a source whose files are there, too: what an overlay of a pack lacks, the pack has.
    pub mark: Option<&'static str>,
    /// The namespace of a name that has none.
    pub namespace: Option<&'static str>,
    /// Whether a file is also found by its name in the folders below a search folder.
    pub deep: bool,
    /// Whether the `#version` lines of included files are ignored.
    pub drops_version: bool,
}

const PLAIN: Lookup = Lookup {
    style: Style::Quote,
    name: "quote",
    directive: None,
    patterns: &["{path}"],
    from_here: &[],
    ancestors: &[],
    own_first: false,
    mark: None,
    namespace: None,
    deep: false,
    drops_version: false,
};

/// All styles.
pub static STYLES: &[Lookup] = &[
    PLAIN,
    Lookup {
        style: Style::Moj,
        name: "moj",
        directive: Some(ImportDirective { name: "moj_import", once: true, extension: Some("GL_MC_moj_import") }),
        patterns: &[
            "assets/{namespace}/shaders/include/{path}",
            "{namespace}/shaders/include/{path}",
            "shaders/include/{path}",
            "include/{path}",
            "{path}",
        ],
        from_here: &["../include/{path}", "include/{path}"],
        ancestors: &["assets", "shaders"],
        own_first: true,
        mark: Some("pack.mcmeta"),
        namespace: Some("minecraft"),
        drops_version: true,
        ..PLAIN
    },
    Lookup { style: Style::Three, name: "three", patterns: &["{path}.glsl.js", "{path}.glsl", "{path}"], ..PLAIN },
    Lookup {
        style: Style::Stk,
        name: "stk",
        directive: Some(ImportDirective { name: "stk_include", once: false, extension: None }),
        ancestors: &["shaders"],
        ..PLAIN
    },
    Lookup { style: Style::Ogre, name: "ogre", deep: true, ..PLAIN },
];

impl Style {
    /// The properties.
    pub fn lookup(self) -> &'static Lookup {
        STYLES.iter().find(|row| row.style == self).unwrap_or(&PLAIN)
    }

    /// The style with this name.
    pub fn named(name: &str) -> Option<Self> {
        STYLES.iter().find(|row| row.name == name).map(|row| row.style)
    }
}

impl Lookup {
    /// The paths of an included file below a search folder, in the order in which they are tried.
    pub fn paths(&self, name: &str) -> Vec<String> {
        self.filled(self.patterns, name)
    }

    /// The paths of an included file from the folder of the including one, after all others.
    pub fn paths_from_here(&self, name: &str) -> Vec<String> {
        self.filled(self.from_here, name)
    }

    fn filled(&self, patterns: &[&str], name: &str) -> Vec<String> {
        let (namespace, path) = match (self.namespace, name.split_once(':')) {
            (Some(_), Some((namespace, path))) => (namespace, path),
            (Some(namespace), None) => (namespace, name),
            (None, _) => ("", name),
        };
        patterns.iter().map(|pattern| pattern.replace("{namespace}", namespace).replace("{path}", path)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{STYLES, Style};

    #[test]
    fn names_become_paths() {
        assert!(Style::Moj.lookup().paths("a:b.glsl").contains(&"assets/a/shaders/include/b.glsl".to_owned()));
        assert!(Style::Moj.lookup().paths("b.glsl").contains(&"minecraft/shaders/include/b.glsl".to_owned()));
        assert_eq!(Style::Three.lookup().paths("fog")[0], "fog.glsl.js");
        assert_eq!(Style::Quote.lookup().paths("c:/b"), ["c:/b"]);
        for row in STYLES {
            assert_eq!(Style::named(row.name), Some(row.style));
        }
    }
}
