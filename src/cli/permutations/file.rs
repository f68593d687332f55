//! The file of `--permutations`.
//!
//! ```toml
//! [[program]]
//! files = ["uber.vert", "uber.frag"]   # relative to this file
//! name = "uber"                        # without it, the stem of the first file
//! defines = { MAX_LIGHTS = 4 }         # in every variant
//! pragmas = true                       # the lines `#pragma multi_compile` and `shader_feature` of the sources
//! keywords = ["multi_compile _ FOG_LINEAR FOG_EXP", "shader_feature NORMAL_MAP"]
//! variants = ["SKINNED=1,BONES=4", ""] # lists of defines
//! skip = ["FOG_EXP !NORMAL_MAP"]       # variants that are left out
//! only = []                            # if there are any, the variants that are left
//! [program.values]
//! LIGHTS = [0, 1, 2, 4]
//! SHADOWS = [false, true]              # not defined; defined as 1
//!
//! [[scene]]
//! file = "room.toml"                   # each draw's program, without what the scene does not need
//! dynamic = ["time"]
//! ```
//!
//! *In:* the text. *Out:* [`Permutations`]. *Holds:* unknown keys are errors; a condition with a name that no variant has, too.

use super::axes::{Axis, Condition, Variant, define, variants};
use crate::cli::exit::{Exit, Failure};
use crate::cli::files;
use crate::cli::toml_errors;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The file as it is.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    program: Vec<ProgramTable>,
    #[serde(default)]
    scene: Vec<SceneTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProgramTable {
    files: Vec<String>,
    name: Option<String>,
    #[serde(default)]
    defines: BTreeMap<String, Value>,
    #[serde(default)]
    pragmas: bool,
    #[serde(default)]
    keywords: Vec<String>,
    #[serde(default)]
    variants: Vec<String>,
    #[serde(default)]
    skip: Vec<String>,
    #[serde(default)]
    only: Vec<String>,
    #[serde(default)]
    values: toml::Table,
}

/// A scene whose draws are variants of their programs.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    /// The scene file.
    pub(super) file: String,
    /// The uniforms that change from frame to frame, added to those of the scene.
    #[serde(default)]
    pub(super) dynamic: Vec<String>,
}

/// The value of a macro: `false` if it is not defined.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "the value of a macro is a number, a text, `true` or `false`; a list of values, one for each variant, goes under `[program.values]`"
)]
enum Value {
    Flag(bool),
    Integer(i64),
    Float(f64),
    Text(String),
}

impl Value {
    fn text(&self) -> Option<String> {
        match self {
            Self::Flag(false) => None,
            Self::Flag(true) => Some("1".to_owned()),
            Self::Integer(number) => Some(number.to_string()),
            // As GLSL writes it: with a point.
            Self::Float(number) => Some(format!("{number:?}")),
            Self::Text(text) => Some(text.clone()),
        }
    }
}

/// A program with its variants.
#[derive(Debug)]
pub(super) struct PermutedProgram {
    /// The name, unique in the file.
    pub(super) name: String,
    /// The files of its stages.
    pub(super) files: Vec<String>,
    /// Its variants, at least one.
    pub(super) variants: Vec<Variant>,
    /// The macros that differ between variants.
    pub(super) names: BTreeSet<String>,
}

/// All that a file asks for.
#[derive(Debug)]
pub(super) struct Permutations {
    /// The programs.
    pub(super) programs: Vec<PermutedProgram>,
    /// The scenes.
    pub(super) scenes: Vec<SceneTable>,
}

/// Reads a file.
///
/// # Errors
/// It cannot be read, or its content is wrong.
pub(super) fn read(path: &Path) -> Result<Permutations, Failure> {
    let name = path.display().to_string();
    let bytes = files::read(&name, path).map_err(|error| Failure::usage(error.message))?;
    let wrong = |why: String| Failure::new(Exit::Content, format!("in `{name}`: {why}"));
    let text = String::from_utf8(bytes).map_err(|_| wrong("it is not text in UTF-8".to_owned()))?;
    let file: File = toml::from_str(&text).map_err(|error| {
        let (message, help) = toml_errors::explained(&error);
        // The text before the message shows the place.
        let shown = error.to_string().replace(error.message().trim(), &message);
        let failure = wrong(shown.trim_end().to_owned());
        if let Some(help) = help { failure.help(help) } else { failure }
    })?;
    if file.program.is_empty() && file.scene.is_empty() {
        return Err(wrong("there is no `[[program]]` and no `[[scene]]`".to_owned()));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut programs: Vec<PermutedProgram> = Vec::new();
    for table in &file.program {
        let program = program(table, folder).map_err(|why| {
            let first = table.files.first().map_or("", String::as_str);
            wrong(format!("the program `{}`: {why}", table.name.as_deref().unwrap_or(first)))
        })?;
        if programs.iter().any(|other| other.name == program.name) {
            return Err(wrong(format!("two programs are named `{}`; give one of them a `name`", program.name)));
        }
        programs.push(program);
    }
    let below = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let scenes = file.scene.into_iter().map(|scene| SceneTable { file: below(&scene.file), ..scene }).collect();
    Ok(Permutations { programs, scenes })
}

fn program(table: &ProgramTable, folder: &Path) -> Result<PermutedProgram, String> {
    let paths: Vec<PathBuf> = table.files.iter().map(|name| folder.join(name)).collect();
    let first = paths.first().ok_or("it has no files")?;
    let name = table.name.clone().unwrap_or_else(|| crate::sources::stages::stem(first));
    let is_name = !name.is_empty() && !name.starts_with('.') && !name.contains(['/', '\\', '\0']);
    if !is_name {
        return Err(format!("`{name}` is no name for a folder"));
    }
    let axes = axes(table, &paths)?;
    let conditions = |texts: &[String]| texts.iter().map(|text| Condition::new(text)).collect::<Result<Vec<_>, _>>();
    let (skip, only) = (conditions(&table.skip)?, conditions(&table.only)?);
    let names: BTreeSet<String> =
        axes.iter().flat_map(|axis| &axis.choices).flat_map(|choice| choice.keys().cloned()).collect();
    for other in skip.iter().chain(&only).flat_map(Condition::names) {
        if !names.contains(other) && !table.defines.contains_key(other) {
            let near = glisten_front::diagnostic::did_you_mean(other, names.iter().map(String::as_str));
            let help = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            return Err(format!("no variant has `{other}`{help}"));
        }
    }
    let variants = variants(&axes, &skip, &only)?;
    if variants.is_empty() {
        return Err("its conditions leave no variant".to_owned());
    }
    let files = paths.iter().map(|path| path.to_string_lossy().into_owned()).collect();
    Ok(PermutedProgram { name, files, variants, names })
}

/// The choices of a program, those of all variants first.
fn axes(table: &ProgramTable, paths: &[PathBuf]) -> Result<Vec<Axis>, String> {
    let checked = |name: &str, value: Option<String>| match value {
        Some(value) => define(&format!("{name}={value}")).map(|(_, value)| Some(value)),
        None => Ok(None),
    };
    let mut axes = Vec::new();
    for (name, value) in &table.defines {
        axes.push(Axis::of_values(name, [checked(name, value.text())?]));
    }
    let mut lines = table.keywords.clone();
    for path in paths.iter().filter(|_| table.pragmas) {
        let bytes = files::read(&path.to_string_lossy(), path).map_err(|error| error.message)?;
        for line in String::from_utf8_lossy(&bytes).lines().filter(|line| is_keyword_pragma(line)) {
            // Both stages may have the line.
            if !lines.iter().any(|known| known == line.trim()) {
                lines.push(line.trim().to_owned());
            }
        }
    }
    for line in &lines {
        axes.push(Axis::of_keywords(line)?);
    }
    for (name, list) in &table.values {
        let values: Vec<Value> = list.clone().try_into().map_err(|_| {
            format!("`values.{name}` is no list of values; write `{name} = [0, 1]` or `{name} = [false, true]`")
        })?;
        if values.is_empty() {
            return Err(format!("`values.{name}` has no value"));
        }
        let values = values.iter().map(|value| checked(name, value.text())).collect::<Result<Vec<_>, _>>()?;
        axes.push(Axis::of_values(name, values));
    }
    if !table.variants.is_empty() {
        axes.push(Axis::of_lists(&table.variants)?);
    }
    Ok(axes)
}

fn is_keyword_pragma(line: &str) -> bool {
    let rest = line.trim().strip_prefix('#').and_then(|rest| rest.trim_start().strip_prefix("pragma"));
    let rest = rest.map_or("", str::trim_start);
    rest.starts_with("multi_compile") || rest.starts_with("shader_feature")
}

#[cfg(test)]
mod tests {
    use super::read;
    use std::fs;

    #[test]
    fn a_file_is_read_and_mistakes_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("p.toml");
        fs::write(folder.path().join("a.frag"), "#pragma multi_compile _ FOG\nvoid main() {}\n").expect("written");
        let read = |text: &str| {
            fs::write(&path, text).expect("written");
            read(&path)
        };
        let text = "[[program]]\nfiles = [\"a.frag\"]\npragmas = true\ndefines = { FIXED = 1.0 }\nskip = [\"FOG !LIT\"]\n\
                    [program.values]\nLIT = [false, true]\nN = [1, 2, \"X\"]\n";
        let found = read(text).expect("a good file");
        let program = &found.programs[0];
        assert_eq!((program.name.as_str(), program.variants.len()), ("a", 9));
        assert!(program.variants.iter().all(|variant| variant["FIXED"] == "1.0"));
        for (text, why) in [
            ("", "no `[[program]]`"),
            ("[[program]]\n", "files"),
            ("[[program]]\nfiles = []\n", "no files"),
            ("[[program]]\nfiles = [\"a.frag\"]\nlist = 1\n", "list"),
            ("[[program]]\nfiles = [\"a.frag\"]\nskip = [\"LITT\"]\nvalues = { LIT = [1] }\n", "did you mean `LIT`"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { LIT = 1 }\n", "no list"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { LIT = [] }\n", "no value"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { \"1\" = [1] }\n", "not a name"),
            ("[[program]]\nfiles = [\"a.frag\"]\nkeywords = [\"multi A\"]\n", "multi_compile"),
            ("[[program]]\nfiles = [\"a.frag\"]\nname = \"../x\"\n", "no name"),
            ("[[program]]\nfiles = [\"a.frag\"]\n[[program]]\nfiles = [\"a.frag\"]\n", "two programs"),
            ("[[program]]\nfiles = [\"a.frag\"]\nonly = [\"A\"]\nskip = [\"A\"]\nvalues = { A = [1] }\n", "no variant"),
        ] {
            let failure = format!("{:?}", read(text).expect_err(text));
            assert!(failure.contains(why), "{text}: {failure}");
        }
    }
}
