//! [`Dialect`]: what a host wants of texts for Vulkan.
//!
//! *In:* nothing. *Out:* settings, as data. *Holds:* the default is GLSL 4.50 by GL_KHR_vulkan_glsl, with every number in the text.

use glisten_front::source::Included;
use glisten_sources::engines::code::{without_comments, words};
use std::collections::BTreeMap;

/// Which numbers the texts state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Numbering {
    /// Sets, bindings and locations.
    #[default]
    All,
    /// Locations alone: the host sets bindings by name.
    Locations,
    /// None: the host matches names.
    None,
}

/// A block that the host has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HostBlock {
    /// Its name.
    pub name: String,
    /// The line that brings it into a text.
    pub line: String,
    /// The name of the included file that has it; without it the line declares the block.
    pub include: Option<String>,
    /// Its members, each as it is declared: type, name, sizes.
    pub members: Vec<(String, String)>,
}

impl HostBlock {
    /// The declaration of the block.
    pub fn declaration(&self) -> String {
        let members: String = self.members.iter().map(|(ty, name)| format!("    {ty} {name};\n")).collect();
        format!("layout(std140) uniform {} {{\n{members}}};\n", self.name)
    }

    /// Whether a text declares the block.
    pub fn is_in(&self, text: &str) -> bool {
        let code = without_comments(text);
        let mut words = words(&code).map(|(_, word)| word).skip_while(|word| *word != "uniform");
        words.any(|word| word == self.name)
    }
}

/// The wishes of a host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dialect {
    /// The numbers in the texts.
    pub numbering: Numbering,
    /// Whether members of blocks have their offsets.
    pub offsets: bool,
    /// Whether clip-space z, `gl_FragCoord`, `dFdy` and the names of indices change.
    pub coordinates: bool,
    /// Whether the host has geometry stages.
    pub geometry: bool,
    /// The blocks that the host has.
    pub blocks: Vec<HostBlock>,
    /// Names that the host has changed, and their new ones.
    pub renamed: BTreeMap<String, String>,
    /// A line after `#version` of each source.
    pub extension: Option<String>,
    /// The word of the directive that includes, if there is only one: `include`, `moj_import`.
    pub directive: Option<String>,
    /// Included files that were moved, each with the folder between the old place and the file.
    pub moved: BTreeMap<String, String>,
}

impl Default for Dialect {
    fn default() -> Self {
        Self {
            numbering: Numbering::All,
            offsets: true,
            coordinates: true,
            geometry: true,
            blocks: Vec::new(),
            renamed: BTreeMap::new(),
            extension: None,
            directive: None,
            moved: BTreeMap::new(),
        }
    }
}

impl Dialect {
    /// The block of the host's file with a path.
    pub fn block_of(&self, path: &str) -> Option<&HostBlock> {
        let is_named = |block: &&HostBlock| block.include.as_deref().is_some_and(|name| plain(name) == plain(path));
        self.blocks.iter().find(is_named)
    }

    /// The text of an included file of the host that is not there: its block alone.
    pub fn stand_in(&self, path: &str) -> Option<Included> {
        let block = self.block_of(path)?;
        Some(Included { name: format!("<{path}>"), text: block.declaration().into() })
    }

    /// The block that has a member, and the new name of it.
    pub(super) fn known(&self, name: &str) -> Option<usize> {
        let name = self.renamed.get(name).map_or(name, String::as_str);
        self.blocks.iter().position(|block| block.members.iter().any(|(_, member)| member == name))
    }
}

/// A path without the namespace of Minecraft.
pub fn plain(path: &str) -> &str {
    path.strip_prefix("minecraft:").unwrap_or(path)
}
