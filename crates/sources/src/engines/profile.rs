//! [`Profile`]: an engine by name, as its file in `profiles` describes it.
//!
//! *In:* a name, then the text and the stage of a source. *Out:* the version of sources without one, macros, preludes, how
//! includes are found. *Holds:* a test reads every file; only the keys of [`Settings`] mean anything.

use super::code::{without_comments, words};
use super::style::Style;
use super::{isf, needed};
use glisten_front::Stage;
use glisten_front::compiler::Problem;
use glisten_front::source::{Prelude, version_line};
use indexmap::IndexMap;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::ops::Range;
use std::sync::LazyLock;

/// An embedded profile: its name, its settings, and its preludes, each for one stage or for all.
type Embedded = (&'static str, &'static str, &'static [(Option<Stage>, &'static str, &'static str)]);

macro_rules! prelude {
    ($stage:expr, $file:literal) => {
        ($stage, $file, include_str!(concat!("profiles/", $file)))
    };
}
macro_rules! profile {
    ($name:literal $(, $prelude:expr)*) => {
        ($name, include_str!(concat!("profiles/", $name, ".json")), &[$($prelude),*])
    };
}

static EMBEDDED: &[Embedded] = &[
    profile!("minecraft"),
    profile!("optifine"),
    profile!("iris"),
    profile!("libretro"),
    profile!(
        "isf",
        prelude!(None, "isf.glsl"),
        prelude!(Some(Stage::Vertex), "isf.vert.glsl"),
        prelude!(Some(Stage::Fragment), "isf.frag.glsl")
    ),
    profile!("openscenegraph"),
    profile!(
        "three",
        prelude!(Some(Stage::Vertex), "three.vert.glsl"),
        prelude!(Some(Stage::Fragment), "three.frag.glsl")
    ),
    profile!("supertuxkart"),
    profile!("shadertoy", prelude!(Some(Stage::Fragment), "shadertoy.glsl")),
];

/// The folder of the embedded preludes, as diagnostics show it. It is not on disk.
pub const SHOWN: &str = "<glisten>/engines/";

/// The keys of a profile's file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
struct Settings {
    /// One line for people.
    about: String,
    /// Reasons for settings, in their order, for those who change them.
    #[serde(rename = "why")]
    _why: IgnoredAny,
    /// Another profile, whose settings hold where this one has none.
    extends: Option<String>,
    /// The version of sources without a `#version` line.
    pub version: Option<String>,
    include_style: Option<String>,
    /// The names of folders above a source in which its includes are searched.
    roots: Vec<String>,
    /// The stage of files whose names tell none.
    stage: Option<String>,
    /// The names of files next to a source that are read before it.
    before: Vec<String>,
    /// The version that sources of older ones get.
    least_version: Option<String>,
    /// The extension of files that are never shaders, only included by some; or, with a slash at the end, the end of the path to a folder of
    /// such files.
    parts: Option<String>,
    /// Whether the engine's own preprocessor lets a macro be defined again.
    redefines: Option<bool>,
    /// Whether the engine makes outputs of `gl_FragColor` and `gl_FragData`, besides declared ones.
    mixes_outputs: Option<bool>,
    /// The names of samplers that the engine replaces where they are no call, so that they hide no built-in function.
    replaced_samplers: Vec<String>,
    /// Whether the engine unrolls the loops between two pragmas.
    unrolls: Option<bool>,
    /// The kind of files next to the sources that describe programs.
    pub programs: Option<String>,
    /// The kind of header that the sources begin with.
    header: Option<String>,
    /// The pragma that names the macros that a source takes.
    define_pragma: Option<String>,
    pub defines: IndexMap<String, String>,
    /// Macros of one stage.
    vertex: IndexMap<String, String>,
    fragment: IndexMap<String, String>,
    geometry: IndexMap<String, String>,
}

/// An engine.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Its name.
    pub name: &'static str,
    /// One line for people.
    pub about: String,
    /// The version of sources without a `#version` line.
    pub version: Option<String>,
    /// How includes are named.
    pub style: Option<Style>,
    /// The names of folders above a source in which its includes are searched.
    pub roots: Vec<String>,
    /// The stage of files whose names tell none.
    pub stage: Option<Stage>,
    /// The names of files next to a source that are read before it; the first one that is there.
    pub before: Vec<String>,
    /// The version that sources of older ones get.
    pub least_version: Option<String>,
    /// The extension of files that are never shaders, only included by some; or, with a slash, a folder of such files.
    pub parts: Option<String>,
    /// Whether the engine's own preprocessor lets a macro be defined again.
    pub redefines: Option<bool>,
    /// Whether the engine makes outputs of `gl_FragColor` and `gl_FragData`, besides declared ones.
    pub mixes_outputs: Option<bool>,
    /// The names of samplers that the engine replaces where they are no call, so that they hide no built-in function.
    pub replaced_samplers: Vec<String>,
    /// Whether the engine unrolls the loops between two pragmas.
    pub unrolls: Option<bool>,
    /// Whether files of JSON next to the sources describe programs, with macros.
    pub has_program_files: bool,
    /// Whether sources begin with a header of the Interactive Shader Format.
    pub has_isf_header: bool,
    define_pragma: Option<String>,
    defines: IndexMap<String, String>,
    by_stage: [(Stage, IndexMap<String, String>); 3],
    preludes: &'static [(Option<Stage>, &'static str, &'static str)],
}

/// The macros and texts that an engine adds to one source.
#[derive(Clone, Debug, Default)]
pub struct Addition {
    /// Macros.
    pub defines: Vec<(String, String)>,
    /// Texts before the source.
    pub preludes: Vec<Prelude>,
    /// Errors in what the engine reads from the source.
    pub problems: Vec<Problem>,
}

/// All profiles.
pub static PROFILES: LazyLock<Vec<Profile>> = LazyLock::new(|| EMBEDDED.iter().map(load).collect());

/// The profile with this name.
pub fn find(name: &str) -> Option<&'static Profile> {
    PROFILES.iter().find(|profile| profile.name == name)
}

/// The names of all profiles.
pub fn names() -> impl Iterator<Item = &'static str> {
    EMBEDDED.iter().map(|(name, ..)| *name)
}

/// The stage that a word names, as engines write it.
pub fn stage_named(word: &str) -> Option<Stage> {
    static NAMES: &[(Stage, &[&str])] = &[
        (Stage::Vertex, &["vertex", "vert", "vs", "vertexshader", "vertex_shader", "vertexprogram"]),
        (
            Stage::Fragment,
            &[
                "fragment",
                "frag",
                "fs",
                "pixel",
                "ps",
                "fragmentshader",
                "fragment_shader",
                "pixelshader",
                "fragmentprogram",
            ],
        ),
        (Stage::Geometry, &["geometry", "geom", "gs", "geometryshader", "geometry_shader"]),
    ];
    let is_named = |names: &&[&str]| names.iter().any(|name| name.eq_ignore_ascii_case(word));
    NAMES.iter().find(|(_, names)| is_named(names)).map(|(stage, _)| *stage)
}

fn load((name, text, preludes): &Embedded) -> Profile {
    let mut settings = settings(text);
    let base = settings.extends.take().and_then(|name| EMBEDDED.iter().find(|row| row.0 == name)).map(load);
    let stages =
        [(Stage::Vertex, settings.vertex), (Stage::Fragment, settings.fragment), (Stage::Geometry, settings.geometry)];
    let own = Profile {
        name,
        about: settings.about,
        version: settings.version,
        style: settings.include_style.as_deref().and_then(Style::named),
        roots: settings.roots,
        stage: settings.stage.as_deref().and_then(stage_named),
        before: settings.before,
        least_version: settings.least_version,
        parts: settings.parts,
        redefines: settings.redefines,
        mixes_outputs: settings.mixes_outputs,
        replaced_samplers: settings.replaced_samplers,
        unrolls: settings.unrolls,
        has_program_files: settings.programs.as_deref() == Some("json"),
        has_isf_header: settings.header.as_deref() == Some("isf"),
        define_pragma: settings.define_pragma,
        defines: settings.defines,
        by_stage: stages,
        preludes,
    };
    match base {
        Some(base) => own.over(base),
        None => own,
    }
}

/// The number of a version: 330 of `330 compatibility`.
fn number(version: &str) -> Option<u16> {
    version.split_whitespace().next()?.parse().ok()
}

fn settings(text: &str) -> Settings {
    serde_json::from_str(text).expect("a test reads every embedded profile")
}

impl Profile {
    /// This profile, with the settings of `base` where it has none.
    fn over(self, base: Self) -> Self {
        let mut defines = base.defines;
        defines.extend(self.defines);
        let mut by_stage = base.by_stage;
        by_stage.iter_mut().zip(self.by_stage).for_each(|((_, all), (_, own))| all.extend(own));
        Self {
            version: self.version.or(base.version),
            style: self.style.or(base.style),
            roots: if self.roots.is_empty() { base.roots } else { self.roots },
            stage: self.stage.or(base.stage),
            least_version: self.least_version.or(base.least_version),
            parts: self.parts.or(base.parts),
            redefines: self.redefines.or(base.redefines),
            mixes_outputs: self.mixes_outputs.or(base.mixes_outputs),
            replaced_samplers: [self.replaced_samplers, base.replaced_samplers].concat(),
            unrolls: self.unrolls.or(base.unrolls),
            define_pragma: self.define_pragma.or(base.define_pragma),
            defines,
            by_stage,
            ..self
        }
    }

    /// The place of the `#version` line of a source that is older than the engine's own version.
    pub fn old_version_line(&self, source: &str) -> Option<Range<usize>> {
        let least = number(self.least_version.as_deref()?)?;
        let line = version_line(source)?;
        let words = source.get(line.clone())?.trim_start_matches('#').trim_start().strip_prefix("version")?;
        // ES is a language of its own.
        (number(words)? < least && !words.contains("es")).then_some(line)
    }

    /// The macros and texts that the engine adds to a source, given the text that has its header: the source itself, or the fragment shader of its
    /// program.
    pub fn addition(&self, source: &str, stage: Stage, header: &str) -> Addition {
        let mut added = Addition::default();
        let own = self.by_stage.iter().filter(|(of, _)| *of == stage).flat_map(|(_, defines)| defines);
        added.defines = self.defines.iter().chain(own).map(|(name, value)| (name.clone(), value.clone())).collect();
        for (of, file, text) in self.preludes {
            if of.is_none_or(|of| of == stage) {
                added.preludes.push(Prelude { name: format!("{SHOWN}{file}"), text: needed::needed(text, source) });
            }
        }
        if self.has_isf_header {
            match isf::inputs(header) {
                Ok(text) => {
                    let prelude =
                        Prelude { name: format!("{SHOWN}isf.inputs.glsl"), text: needed::needed(&text, source) };
                    added.preludes.insert(0, prelude);
                }
                // A vertex shader has no header of its own to report.
                Err(problem) if stage == Stage::Fragment => added.problems.push(problem),
                Err(_) => {}
            }
        }
        added
    }

    /// The macros of the host that a source takes: all, unless the engine wants a pragma that names them.
    pub fn taken(&self, source: &str, defines: Vec<(String, String)>) -> Vec<(String, String)> {
        let Some(pragma) = &self.define_pragma else { return defines };
        let code = without_comments(source);
        let imported: Vec<&str> = code
            .lines()
            .filter_map(|line| line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("pragma"))
            .filter_map(|line| line.trim_start().strip_prefix(pragma.as_str()))
            .flat_map(|names| words(names).map(|(_, name)| name))
            .collect();
        defines.into_iter().filter(|(name, _)| imported.contains(&name.as_str())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{EMBEDDED, PROFILES, find, names, settings};
    use crate::engines::Style;
    use glisten_front::Stage;

    #[test]
    fn every_profile_is_read() {
        for (name, text, _) in EMBEDDED {
            let read = settings(text);
            assert!(!read.about.is_empty(), "{name}");
            assert_eq!(read.stage.is_some(), find(name).is_some_and(|profile| profile.stage.is_some()), "{name}");
            assert!(read.include_style.is_none_or(|style| Style::named(&style).is_some()), "{name}");
            assert!(read.programs.is_none_or(|kind| kind == "json"), "{name}");
            assert!(read.header.is_none_or(|header| header == "isf"), "{name}");
            assert!(read.extends.is_none_or(|base| names().any(|other| other == base)), "{name}");
        }
        assert_eq!(PROFILES.len(), EMBEDDED.len());
    }

    #[test]
    fn iris_is_optifine_and_more() {
        let iris = find("iris").expect("it is one");
        let added = iris.addition("", Stage::Vertex, "");
        let has = |name: &str| added.defines.iter().filter(|(other, _)| other == name).count();
        assert_eq!([has("MC_VERSION"), has("IS_IRIS"), has("MC_GL_VERSION")], [1; 3]);
        assert_eq!(iris.roots, ["shaders"]);
    }

    #[test]
    fn iris_lifts_old_versions() {
        let iris = find("iris").expect("it is one");
        for (text, line) in [
            ("// a\n#version 120\nx", Some("#version 120")),
            ("# version 150 compatibility", Some("# version 150 compatibility")),
            ("#version 330\n", None),
            ("#version 430 compatibility\n", None),
            ("#version 100 es\n", None),
            ("void main() {}", None),
        ] {
            assert_eq!(iris.old_version_line(text).and_then(|line| text.get(line)), line, "{text}");
        }
        assert_eq!(find("optifine").and_then(|optifine| optifine.old_version_line("#version 120")), None);
    }

    #[test]
    fn macros_that_are_not_imported_stay_out() {
        let osg = find("openscenegraph").expect("it is one");
        let given = vec![("A".to_owned(), "1".to_owned()), ("B".to_owned(), "1".to_owned())];
        let source = "#pragma import_defines ( X, B(y) ) // A\n";
        assert_eq!(osg.taken(source, given), [("B".to_owned(), "1".to_owned())]);
    }
}
