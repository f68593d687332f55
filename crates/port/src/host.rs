//! [`Host`]: what programs are ported to, as its file in `hosts` describes it.
//!
//! *In:* a name. *Out:* the language to write, the blocks that the host has, the files that it wants next to the sources. *Holds:* a test reads every
//! file; only the keys of [`Settings`] mean anything.

use glisten_upgrade::{Dialect, HostBlock, Numbering, Target};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

macro_rules! host {
    ($name:literal) => {
        ($name, include_str!(concat!("hosts/", $name, ".toml")))
    };
}

static EMBEDDED: &[(&str, &str)] =
    &[host!("minecraft-26.2"), host!("minecraft-26.3"), host!("vulkan"), host!("wgpu"), host!("bevy"), host!("webgl2")];

/// The keys of a file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
struct Settings {
    /// One line for people.
    about: String,
    /// The engine whose conventions the old sources have.
    engine: Option<String>,
    /// The language to write, as `upgrade --to` names it.
    pub version: String,
    /// `all`, `locations` or `none`; without it, nothing but the language changes.
    numbering: Option<String>,
    /// Whether members of blocks have offsets.
    offsets: bool,
    /// Whether coordinates are Vulkan's.
    coordinates: bool,
    /// The word of the directive that includes.
    directive: Option<String>,
    /// A line after `#version`.
    extension: Option<String>,
    /// The kind of packs whose other files change.
    packs: Option<String>,
    /// Whether WGSL is written, too.
    wgsl: bool,
    /// Whether a module of Rust is written.
    rust: bool,
    /// Whether a header of C is written.
    header: bool,
    /// Names that the host has changed.
    renamed: BTreeMap<String, String>,
    /// The blocks that the host has.
    block: Vec<BlockSettings>,
}

/// A block that the host has.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct BlockSettings {
    name: String,
    /// The file that declares it; without it each source does.
    include: Option<String>,
    /// Each a type and a name.
    members: Vec<String>,
}

/// A host that programs are ported to.
#[derive(Clone, Debug)]
pub struct Host {
    /// Its name.
    pub name: &'static str,
    /// One line for people.
    pub about: String,
    /// The engine whose conventions the old sources have.
    pub engine: Option<String>,
    /// The language to write.
    pub target: Target,
    /// The rules by which the texts are rewritten after that.
    pub dialect: Option<Dialect>,
    /// Whether packs of Minecraft have other files that change.
    pub is_minecraft: bool,
    /// Whether WGSL is written, too.
    pub has_wgsl: bool,
    /// Whether a module of Rust is written.
    pub has_rust: bool,
    /// Whether a header of C is written.
    pub has_header: bool,
}

/// All hosts.
pub static HOSTS: LazyLock<Vec<Host>> =
    LazyLock::new(|| EMBEDDED.iter().map(|(name, text)| load(name, text)).collect());

/// The names of all hosts.
pub fn host_names() -> impl Iterator<Item = &'static str> {
    EMBEDDED.iter().map(|(name, _)| *name)
}

/// The host with this name.
pub fn find_host(name: &str) -> Option<&'static Host> {
    HOSTS.iter().find(|host| host.name == name)
}

fn load(name: &'static str, text: &str) -> Host {
    // A test reads every file; here, one that cannot be read has no settings.
    let settings: Settings = toml::from_str(text).unwrap_or_default();
    let target = Target::ALL.iter().find(|(word, _)| *word == settings.version).map(|(_, target)| *target);
    // A host with wishes for Vulkan reads its texts by both rules.
    let target = match target {
        Some(Target::Core330) if settings.numbering.is_some() => Target::Both330,
        other => other.unwrap_or(Target::Core330),
    };
    let numbering = settings.numbering.as_deref().map(|word| match word {
        "all" => Numbering::All,
        "locations" => Numbering::Locations,
        _ => Numbering::None,
    });
    let directive = settings.directive.clone();
    let dialect = numbering.map(|numbering| Dialect {
        numbering,
        offsets: settings.offsets,
        coordinates: settings.coordinates,
        // WebGPU has none.
        geometry: !settings.wgsl,
        blocks: settings.block.iter().map(|one| block(one, directive.as_deref())).collect(),
        renamed: settings.renamed,
        extension: settings.extension,
        directive: settings.directive,
        ..Dialect::default()
    });
    Host {
        name,
        about: settings.about,
        engine: settings.engine,
        target,
        dialect,
        is_minecraft: settings.packs.as_deref() == Some("minecraft"),
        has_wgsl: settings.wgsl,
        has_rust: settings.rust,
        has_header: settings.header,
    }
}

fn block(one: &BlockSettings, directive: Option<&str>) -> HostBlock {
    let member = |text: &String| text.split_once(' ').map(|(ty, name)| (ty.to_owned(), name.to_owned()));
    let members: Vec<(String, String)> = one.members.iter().filter_map(member).collect();
    let include = one.include.clone();
    let line = match &include {
        Some(include) => format!("#{} <{include}>", directive.unwrap_or("include")),
        None => {
            let lines: String = members.iter().map(|(ty, name)| format!("    {ty} {name};\n")).collect();
            format!("layout(std140) uniform {} {{\n{lines}}};", one.name)
        }
    };
    HostBlock { name: one.name.clone(), line, include, members }
}

#[cfg(test)]
mod tests {
    use super::{EMBEDDED, HOSTS, Settings};
    use glisten_sources::engines::find;
    use glisten_upgrade::Target;

    #[test]
    fn every_file_can_be_read() {
        for (name, text) in EMBEDDED {
            let settings: Settings = toml::from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(!settings.about.is_empty(), "{name}");
            assert!(Target::ALL.iter().any(|(word, _)| *word == settings.version), "{name}");
            assert!(settings.engine.is_none_or(|engine| find(&engine).is_some()), "{name}");
            let words = ["all", "locations", "none"];
            assert!(settings.numbering.is_none_or(|word| words.contains(&word.as_str())), "{name}");
        }
        for host in HOSTS.iter() {
            let blocks = host.dialect.iter().flat_map(|dialect| &dialect.blocks);
            assert!(blocks.into_iter().all(|block| !block.members.is_empty()), "{}", host.name);
        }
    }
}
