//! [`Settings`]: how one source is completed, and the completion.
//!
//! *In:* an engine, a version, preludes, macros, search folders; then a source. *Out:* [`Prepared`]: its part of a file with
//! several stages, macros, preludes, the version if it has none, and the resolver of its includes. *Holds:* the settings take
//! precedence over the profile of the engine.

use super::disk::Disk;
use super::includes::DiskIncludes;
use super::programs::ProgramFiles;
use super::stages;
use crate::engines::{self, Member, Profile, Style, combined};
use glisten_front::compiler::{Prepared, Source, SourceSettings};
use glisten_front::hir::Stage;
use glisten_front::language::EDITIONS;
use glisten_front::source::{Completion, Prelude, blanked};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The settings of a source.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Its engine.
    pub profile: Option<&'static Profile>,
    /// The version, if it has no `#version` line.
    pub version: Option<String>,
    /// How it names the files that it includes.
    pub style: Option<Style>,
    /// The texts before it.
    pub preludes: Vec<Prelude>,
    /// Macros.
    pub defines: Vec<(String, String)>,
    /// The search folders of its includes.
    pub folders: Vec<PathBuf>,
    /// The programs that files next to sources describe.
    pub programs: ProgramFiles,
}

impl Settings {
    /// Whether there is nothing to complete.
    fn is_plain(&self) -> bool {
        let no_engine = self.profile.is_none() && self.version.is_none() && self.style.is_none();
        no_engine && self.preludes.is_empty() && self.defines.is_empty() && self.folders.is_empty()
    }

    /// The settings that a host gives.
    pub fn from_host(host: &SourceSettings) -> Self {
        Self {
            profile: host.engine.as_deref().and_then(engines::find),
            version: host.version.clone(),
            style: host.include_style.as_deref().and_then(Style::named),
            preludes: host.preludes.clone(),
            folders: host.includes.iter().map(PathBuf::from).collect(),
            ..Self::default()
        }
    }

    /// These settings, and where they say nothing, those of `base`. Search folders are searched in this order; preludes of `base`
    /// come first.
    #[must_use]
    pub fn over(self, base: Self) -> Self {
        Self {
            profile: self.profile.or(base.profile),
            version: self.version.or(base.version),
            style: self.style.or(base.style),
            preludes: [base.preludes, self.preludes].concat(),
            defines: [base.defines, self.defines].concat(),
            folders: [self.folders, base.folders].concat(),
            programs: base.programs,
        }
    }

    /// The source as it is compiled. `path` is its file, if it has one.
    pub fn complete(self, source: &Source, path: Option<&Path>, disk: Arc<dyn Disk>) -> Prepared {
        let mut prepared = Prepared::default();
        let members = members(path, &source.text);
        if let Some(part) = members.iter().find_map(|member| member.part(source.stage)) {
            prepared.text = (!part.others.is_empty()).then(|| part.text(&source.text));
            prepared.defines.clone_from(&part.defines);
        }
        if !self.is_plain() {
            self.add(source, path, disk, &mut prepared);
        }
        prepared
    }

    /// Adds what belongs to the source.
    fn add(self, source: &Source, path: Option<&Path>, disk: Arc<dyn Disk>, prepared: &mut Prepared) {
        if self.profile.is_some_and(|profile| profile.has_program_files) {
            prepared.defines.extend(self.programs.macros(source, &*disk));
        }
        let style = self.style.or(self.profile.and_then(|profile| profile.style));
        let roots = self.profile.map_or(&[][..], |profile| &profile.roots);
        let mut version = self.version.or(self.profile.and_then(|profile| profile.version.clone()));
        let own = prepared.text.as_ref().unwrap_or(&source.text);
        if let Some((profile, line)) = self.profile.and_then(|profile| Some((profile, profile.old_version_line(own)?)))
        {
            prepared.text = Some(blanked(own, &[line]));
            version.clone_from(&profile.least_version);
        }
        let includes = DiskIncludes::new(Arc::clone(&disk), self.folders, style.unwrap_or(Style::Quote), roots);
        let own = prepared.text.as_ref().unwrap_or(&source.text);
        if let Some((line, lifted)) = includes.lifted_version(own, &source.name) {
            prepared.text = Some(blanked(own, &[line]));
            version = Some(lifted);
        }
        let text = prepared.text.as_ref().unwrap_or(&source.text);
        let addition = |profile: &Profile| profile.addition(text, source.stage, &header(profile, source, path, &*disk));
        let mut added = self.profile.map(addition).unwrap_or_default();
        let taken = match self.profile {
            Some(profile) => profile.taken(text, self.defines),
            None => self.defines,
        };
        let of_stage = std::mem::take(&mut prepared.defines);
        prepared.defines = last_of_each(added.defines.into_iter().chain(of_stage).chain(taken).collect());
        added.preludes.extend(self.profile.and_then(|profile| companion(profile, &source.name, &*disk)));
        added.preludes.extend(self.preludes);
        prepared.completion = Completion {
            assumed_version: version,
            preludes: added.preludes,
            directive: style.and_then(|style| style.lookup().directive),
            resolves_includes: style.is_some(),
            redefines: self.profile.and_then(|profile| profile.redefines).unwrap_or(false),
            mixes_outputs: self.profile.and_then(|profile| profile.mixes_outputs).unwrap_or(false),
            replaced_samplers: self.profile.map(|profile| profile.replaced_samplers.clone()).unwrap_or_default(),
            unrolls: self.profile.and_then(|profile| profile.unrolls).unwrap_or(false),
        };
        prepared.problems = added.problems;
        prepared.includes = Some(Arc::new(includes));
    }
}

/// A version as a `#version` line has it: `330`, `150 core`, `300 es`; `300es` will do.
pub fn parse_version(text: &str) -> Result<String, String> {
    let text = text.trim();
    let text = text.strip_prefix("#version").map_or(text, str::trim);
    let (number, profile) = text.split_at(text.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(text.len()));
    let profile = profile.trim();
    if number.len() != 3 || !["", "core", "compatibility", "es"].contains(&profile) {
        return Err(format!("`{text}` is no version: write a number and a profile, such as `150 core`"));
    }
    if !EDITIONS.iter().any(|edition| number.parse() == Ok(edition.number)) {
        return Err(format!("there is no GLSL version {number}: `glisten versions` lists them"));
    }
    Ok(format!("{number} {profile}").trim().to_owned())
}

/// The file next to a source that its engine reads before it.
fn companion(profile: &Profile, source: &str, disk: &dyn Disk) -> Option<Prelude> {
    let source = Path::new(source);
    // The names may differ in case alone, and so may files.
    let is_source = |path: &Path| {
        path.file_name().map(|name| name.to_ascii_lowercase())
            == source.file_name().map(|name| name.to_ascii_lowercase())
    };
    let paths = profile.before.iter().map(|name| source.with_file_name(name));
    let is_there = |path: &PathBuf| {
        disk.looked_for(path);
        path.is_file() && !is_source(path)
    };
    let path = paths.into_iter().find(is_there)?;
    let text = disk.text(&path).ok()?;
    Some(Prelude { name: path.to_string_lossy().into_owned(), text })
}

/// The last definition of each macro.
fn last_of_each(defines: Vec<(String, String)>) -> Vec<(String, String)> {
    let mut kept: Vec<(String, String)> = Vec::new();
    for (name, value) in defines {
        kept.retain(|(other, _)| *other != name);
        kept.push((name, value));
    }
    kept
}

/// The programs of a file with several stages; none if its name tells its stage.
pub fn members(path: Option<&Path>, text: &str) -> Vec<Member> {
    if path.is_some_and(|path| stages::by_name(path).is_some()) { Vec::new() } else { combined::members(text) }
}

/// The text with the header of a source: the fragment shader next to a vertex shader, otherwise the source itself.
fn header(profile: &Profile, source: &Source, path: Option<&Path>, disk: &dyn Disk) -> Arc<str> {
    let fragment = || disk.text(&path?.with_extension("fs")).ok().filter(|text| !text.trim().is_empty());
    let is_elsewhere = profile.has_isf_header && source.stage == Stage::Vertex;
    let other = if is_elsewhere { fragment() } else { None };
    other.unwrap_or_else(|| Arc::clone(&source.text))
}
