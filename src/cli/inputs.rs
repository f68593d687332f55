//! Which files a command works on, and which of them form one program.
//!
//! *In:* names on the command line. *Out:* [`Group`]s in the order of their first names: files with the same folder
//! and stem and different stages, and each `--program`.
//!
//! *Holds:* a file that is named twice counts once; a file in a `--program` forms no group of its own.

use super::args::{ProgramArgs, SourceArgs};
use super::config;
use super::engine::{Engines, STDIN as SHOWN_STDIN};
use super::exit::Failure;
use super::files;
use crate::engines::combined;
use crate::sources::{members, stages};
use glisten_front::hir::Stage;
use ignore::WalkBuilder;
use ignore::gitignore::Gitignore;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of standard input on the command line.
const STDIN: &str = "-";

/// A shader to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Input {
    /// The name that diagnostics show.
    pub(super) name: String,
    /// The file; `None` for standard input.
    pub(super) path: Option<PathBuf>,
    /// The stage.
    pub(super) stage: Stage,
    /// The program of the file, if it contains several stages.
    pub(super) part: Option<PartOf>,
}

/// A program of a file that contains several stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PartOf {
    /// Its index.
    index: usize,
    /// Its name, if the file has several programs.
    name: Option<String>,
}

impl PartOf {
    /// The macros that select a stage in a file.
    pub(super) fn defines(&self, file: &str, stage: Stage) -> Vec<(String, String)> {
        let members = combined::members(file);
        let part = members.get(self.index).and_then(|member| member.part(stage));
        part.map(|part| part.defines.clone()).unwrap_or_default()
    }

    /// The text of a stage, where the file has several programs; otherwise the whole text, which is taken apart later.
    pub(super) fn text(&self, text: &Arc<str>, stage: Stage) -> Arc<str> {
        let members = self.name.as_ref().map(|_| combined::members(text)).unwrap_or_default();
        let part = members.get(self.index).and_then(|member| member.part(stage));
        part.map_or_else(|| Arc::clone(text), |part| part.text(text))
    }
}

impl Input {
    /// The name for its outputs: `phong.vert`; for standard input, `stdin.vert`.
    pub(super) fn file_name(&self) -> String {
        match &self.path {
            Some(_) if self.part.is_some() => format!("{}.{}", self.stem(), stages::extension(self.stage)),
            Some(path) => path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            None => format!("stdin.{}", stages::extension(self.stage)),
        }
    }

    /// Whether it is of a program after the first of its file.
    fn is_later(&self) -> bool {
        self.part.as_ref().is_some_and(|part| part.index > 0)
    }

    /// The name without the part that says the stage.
    pub(super) fn stem(&self) -> String {
        let named = self.part.as_ref().and_then(|part| part.name.clone());
        named.or(self.path.as_deref().map(stages::stem)).unwrap_or("stdin".to_owned())
    }
}

/// Files that form one program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// The stem of the first file.
    pub(super) name: String,
    /// The inputs, at least one.
    pub(super) inputs: Vec<Input>,
}

impl Group {
    /// Whether it has only one stage, which will need a partner.
    pub(super) fn is_lone(&self) -> bool {
        self.inputs.iter().all(|input| Some(input.stage) == self.inputs.first().map(|first| first.stage))
    }
}

/// The inputs that the command line names.
#[derive(Debug, Default)]
pub(super) struct Inputs {
    /// The programs.
    pub(super) groups: Vec<Group>,
    /// Folders that contain no shader.
    pub(super) empty_folders: Vec<String>,
    /// The files that a search found and the command line does not name.
    pub(super) found: BTreeSet<String>,
}

/// The scene files that the command line names: files as they are, folders searched for `.toml` files that draw.
///
/// # Errors
/// A folder that cannot be read, or that contains no scene.
pub(super) fn scene_files(names: &[String]) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    for name in names {
        let path = Path::new(name);
        if !path.is_dir() {
            files.push(name.clone());
            continue;
        }
        let mut found: Vec<String> = WalkBuilder::new(path)
            .build()
            .filter_map(Result::ok)
            .filter(|entry| entry.path().extension().is_some_and(|extension| extension == "toml"))
            .filter(|entry| fs::read_to_string(entry.path()).is_ok_and(|text| text.contains("[[draw]]")))
            .map(|entry| entry.path().to_string_lossy().into_owned())
            .collect();
        if found.is_empty() {
            return Err(Failure::usage(format!("there is no scene in `{name}`")));
        }
        found.sort();
        files.append(&mut found);
    }
    Ok(files)
}

/// Collects the inputs of a command. Folders are searched only if `scans` is set. Otherwise they stay in the list,
/// and reading them gives the error.
pub(super) fn collect(
    files: &[String],
    args: &ProgramArgs,
    sources: &SourceArgs,
    scans: bool,
) -> Result<Inputs, Failure> {
    let engines = Engines::new(sources)?;
    let mut inputs = Inputs::default();
    let mut named = Vec::new();
    for file in files {
        if scans && Path::new(file).is_dir() {
            let before = named.len();
            scan(Path::new(file), &engines, &mut named)?;
            if named.len() == before {
                inputs.empty_folders.push(file.clone());
            }
            inputs.found.extend(named.iter().skip(before).cloned());
        } else {
            named.push(file.clone());
        }
    }
    let by_name: BTreeSet<PathBuf> = files.iter().map(|name| identity(name)).collect();
    inputs.found.retain(|name| !by_name.contains(&identity(name)));
    let mut in_programs = BTreeSet::new();
    let mut groups = Vec::new();
    for program in &args.programs {
        let names: Vec<&str> = program.split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
        if names.is_empty() {
            return Err(Failure::usage("--program names no file").help("write `--program a.vert,b.frag`"));
        }
        in_programs.extend(names.iter().map(|name| identity(name)));
        let mut listed = Vec::new();
        for name in names {
            listed.extend(stages_of(name, args, &engines, false)?.into_iter().filter(|input| !input.is_later()));
        }
        groups.push(Group { name: listed.first().map(Input::stem).unwrap_or_default(), inputs: listed });
    }
    let mut seen = BTreeSet::new();
    let alone = named.len() == 1 && args.programs.is_empty();
    let mut listed = Vec::new();
    for name in named.iter().filter(|name| !in_programs.contains(&identity(name)) && seen.insert(identity(name))) {
        listed.extend(stages_of(name, args, &engines, alone)?);
    }
    inputs.groups = group(listed);
    inputs.groups.extend(groups);
    Ok(inputs)
}

/// The program of these files, whatever their names are.
pub(super) fn program(names: &[String], args: &ProgramArgs, sources: &SourceArgs) -> Result<Group, Failure> {
    let engines = Engines::new(sources)?;
    let mut listed = Vec::new();
    for name in names {
        listed.extend(stages_of(name, args, &engines, false)?.into_iter().filter(|input| !input.is_later()));
    }
    Ok(in_pipeline_order(Group { name: listed.first().map(Input::stem).unwrap_or_default(), inputs: listed }))
}

/// A key that is equal for two names of the same file.
fn identity(name: &str) -> PathBuf {
    if name == STDIN { PathBuf::from(STDIN) } else { fs::canonicalize(name).unwrap_or_else(|_| PathBuf::from(name)) }
}

/// The stages of a file: one, unless it contains several.
fn stages_of(name: &str, args: &ProgramArgs, engines: &Engines, alone: bool) -> Result<Vec<Input>, Failure> {
    let given = args.stage.map(Stage::from);
    if name == STDIN {
        let stage = given.ok_or_else(|| {
            Failure::usage("standard input has no name that says its stage").help("add `--stage vertex` or another")
        })?;
        return Ok(vec![Input { name: SHOWN_STDIN.to_owned(), path: None, stage, part: None }]);
    }
    let path = PathBuf::from(name);
    let told = stages::by_name(&path);
    if told.is_none() {
        let parts = parts(name, &path);
        let wanted = |input: &Input| given.is_none_or(|stage| stage == input.stage);
        if parts.iter().any(wanted) {
            return Ok(parts.into_iter().filter(wanted).collect());
        }
    }
    let stage = if alone { given.or(told) } else { told.or(given) }.or_else(|| engines.stage(&path));
    // Reading reports what is not a readable file; its stage does not matter then.
    let stage = stage.or_else(|| (!path.is_file()).then_some(Stage::Vertex));
    match stage {
        Some(stage) => Ok(vec![Input { name: name.to_owned(), path: Some(path), stage, part: None }]),
        None => Err(Failure::usage(format!("the name of `{name}` does not tell its stage"))
            .help(format!("add `--stage vertex` or another, or name it {}", stages::all_extensions()))),
    }
}

/// The stages in a file that contains several.
fn parts(name: &str, path: &Path) -> Vec<Input> {
    let Ok(text) = files::read_source(name, Some(path)) else { return Vec::new() };
    let mut inputs = Vec::new();
    for (index, member) in members(Some(path), &text).into_iter().enumerate() {
        let part = PartOf { index, name: member.name };
        let input =
            |stage| Input { name: name.to_owned(), path: Some(path.to_owned()), stage, part: Some(part.clone()) };
        inputs.extend(member.parts.iter().map(|part| input(part.stage)));
    }
    inputs
}

/// Whether a search of a folder takes a file: its name tells its stage, or its engine does, or it contains several stages.
fn is_shader(path: &Path, engines: &Engines) -> bool {
    if stages::may_be_included(path) && engines.is_part(path) {
        return false;
    }
    let is_whole = stages::by_name(path).is_some() || engines.stage(path).is_some() && stages::may_be_included(path);
    if is_whole {
        return !stages::is_part(path) && !stages::is_assembly(path);
    }
    stages::may_be_combined(path) && !parts(&path.to_string_lossy(), path).is_empty()
}

/// Adds all shaders in a folder and its subfolders, in the order of their names, except what `.gitignore` or the `exclude` of
/// a configuration names. Hidden folders are skipped, and links to folders are not followed, so that a cycle of links does no
/// harm.
fn scan(root: &Path, engines: &Engines, found: &mut Vec<String>) -> Result<(), Failure> {
    let mut excludes: BTreeMap<PathBuf, Option<Gitignore>> = BTreeMap::new();
    let mut walk = WalkBuilder::new(root);
    // Without a repository, `.gitignore` says as much about what is generated.
    walk.hidden(false).require_git(false).filter_entry(|entry| entry.depth() == 0 || !is_hidden_folder(entry));
    let mut files = Vec::new();
    for entry in walk.build() {
        let entry =
            entry.map_err(|error| Failure::usage(format!("cannot read the folder `{}`: {error}", root.display())))?;
        let path = entry.path();
        let is_folder = entry.file_type().is_some_and(|kind| kind.is_dir());
        if !is_folder && is_shader(path, engines) && !is_excluded(path, &mut excludes) {
            files.push(entry.into_path());
        }
    }
    files.sort();
    found.extend(files.into_iter().map(|path| path.to_string_lossy().into_owned()));
    Ok(())
}

fn is_hidden_folder(entry: &ignore::DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| kind.is_dir()) && entry.file_name().to_string_lossy().starts_with('.')
}

/// Whether the nearest configuration excludes a file or a folder that it is in.
fn is_excluded(path: &Path, excludes: &mut BTreeMap<PathBuf, Option<Gitignore>>) -> bool {
    let folder = path.parent().unwrap_or(Path::new(""));
    let patterns = excludes.entry(folder.to_owned()).or_insert_with(|| config::excluded(folder));
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    patterns.as_ref().is_some_and(|patterns| {
        absolute.starts_with(patterns.path()) && patterns.matched_path_or_any_parents(&absolute, false).is_ignore()
    })
}

/// Groups files by folder and stem; each stage occurs at most once in a group. What tessellation stages stand between is no pair.
fn group(inputs: Vec<Input>) -> Vec<Group> {
    let mut groups: Vec<((PathBuf, String, String), Group)> = Vec::new();
    for input in inputs {
        let folder = input.path.as_deref().and_then(Path::parent).map(Path::to_owned).unwrap_or_default();
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        // The stages of one file belong to each other, whatever files of the same stem there are.
        let own = input.part.as_ref().map_or(String::new(), |part| format!("{}:{}", input.name, part.index));
        let key = (folder, input.stem(), own);
        let fits = |group: &Group| group.inputs.iter().all(|other| other.stage != input.stage);
        match groups.iter_mut().find(|(other, group)| *other == key && fits(group)) {
            Some((_, group)) => group.inputs.push(input),
            None => groups.push((key, Group { name: input.stem(), inputs: vec![input] })),
        }
    }
    let groups = groups.into_iter().flat_map(|((folder, stem, own), group)| {
        if own.is_empty() && group.inputs.len() > 1 && stages::is_tessellated(&folder, &stem) {
            let alone = |input: Input| Group { name: group.name.clone(), inputs: vec![input] };
            group.inputs.iter().cloned().map(alone).collect()
        } else {
            vec![group]
        }
    });
    groups.map(in_pipeline_order).collect()
}

/// Sorts the stages in pipeline order, so that the order on the command line does not matter.
fn in_pipeline_order(mut group: Group) -> Group {
    group.inputs.sort_by_key(|input| input.stage);
    group
}

#[cfg(test)]
mod tests {
    use super::{Input, group};
    use crate::sources::stages;
    use glisten_front::hir::Stage;
    use std::path::{Path, PathBuf};

    fn inputs(names: &[&str]) -> Vec<Input> {
        let input = |name: &&str| Input {
            name: (*name).to_owned(),
            path: Some(PathBuf::from(name)),
            stage: stages::by_name(Path::new(name)).expect("the name tells the stage"),
            part: None,
        };
        names.iter().map(input).collect()
    }

    #[test]
    fn files_are_grouped_by_folder_and_stem() {
        let groups = group(inputs(&["b.frag", "a.vert", "x/a.frag", "b.vs", "a.frag", "b.vert"]));
        let shown: Vec<Vec<&str>> =
            groups.iter().map(|group| group.inputs.iter().map(|input| input.name.as_str()).collect()).collect();
        assert_eq!(shown, [vec!["b.vs", "b.frag"], vec!["a.vert", "a.frag"], vec!["x/a.frag"], vec!["b.vert"]]);
        assert!(groups[2].is_lone() && !groups[0].is_lone());
    }

    #[test]
    fn stems_leave_out_what_tells_the_stage() {
        for (name, stem, stage) in [
            ("dir/phong.vert", "phong", Some(Stage::Vertex)),
            ("phong.vert.glsl", "phong", Some(Stage::Vertex)),
            ("a.b.fs", "a.b", Some(Stage::Fragment)),
            ("lib.glsl", "lib", None),
            ("X.GEOM", "X", Some(Stage::Geometry)),
            ("a/phong_vs.glsl", "phong", Some(Stage::Vertex)),
            ("phong-FS.GLSL", "phong", Some(Stage::Fragment)),
            ("PhongVert.glsl", "Phong", Some(Stage::Vertex)),
            ("lightFS.glsl", "light", Some(Stage::Fragment)),
            ("advert.glsl", "advert", None),
            ("vs_phong.glsl", "phong", Some(Stage::Vertex)),
            ("deferred_light_vertex.glsl", "deferred_light", Some(Stage::Vertex)),
            ("fragment.glsl", "program", Some(Stage::Fragment)),
            ("a.vertex", "a", Some(Stage::Vertex)),
            ("a.fragmentshader", "a", Some(Stage::Fragment)),
            ("a.ps", "a", None),
            ("old.vp", "old", Some(Stage::Vertex)),
            ("old_fp.glsl", "old", Some(Stage::Fragment)),
            ("deferred-f.sdr", "deferred", Some(Stage::Fragment)),
            ("light_v.glsl", "light_v", None),
            ("waves.glsl", "waves", None),
            ("_vs.glsl", "_vs", None),
        ] {
            assert_eq!(stages::stem(Path::new(name)), stem, "{name}");
            assert_eq!(stages::by_name(Path::new(name)), stage, "{name}");
        }
    }
}
